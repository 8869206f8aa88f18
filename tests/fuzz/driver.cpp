// Stands in for libFuzzer where there is none: NAME CORPUS_DIR RUNS SEED. Feeds every file of the
// corpus as it is, then RUNS mutations of them, drawn from SEED. A broken promise aborts, after
// the guilty input was written to crash-NAME in the current folder.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

namespace fs = std::filesystem;

using Bytes = std::vector<std::uint8_t>;

Bytes read(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  const std::string content = text.str();
  return {content.begin(), content.end()};
}

std::vector<Bytes> read_corpus(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());  // the order of a directory is not the same everywhere
  std::vector<Bytes> corpus;
  for (const fs::path& file : files) corpus.push_back(read(file));
  return corpus;
}

/// Makes inputs that are nearly right: a few edits of a corpus entry.
class Mutator {
 public:
  Mutator(std::vector<Bytes> corpus, unsigned seed) : corpus_(std::move(corpus)), random_(seed) {}

  Bytes next() {
    Bytes bytes = corpus_[below(corpus_.size())];
    const std::size_t edits = 1 + below(6);
    for (std::size_t i = 0; i < edits; ++i) edit(bytes);
    return bytes;
  }

 private:
  std::size_t below(std::size_t limit) {
    return std::uniform_int_distribution<std::size_t>(0, limit - 1)(random_);
  }
  std::ptrdiff_t place_in(const Bytes& bytes) {
    return static_cast<std::ptrdiff_t>(below(bytes.size() + 1));
  }

  /// A piece of any corpus entry; at most 32 bytes, so that inputs do not explode.
  Bytes snippet() {
    const Bytes& source = corpus_[below(corpus_.size())];
    const std::size_t from = below(source.size() + 1);
    const std::size_t length = std::min(below(32) + 1, source.size() - from);
    const auto begin = source.begin() + static_cast<std::ptrdiff_t>(from);
    return {begin, begin + static_cast<std::ptrdiff_t>(length)};
  }

  void edit(Bytes& bytes) {
    static const std::string kHostile = "0-1.9eE:{}[]&*!|>'\"%@`#,?~\n\t \0\x7f\xff\x80";
    const auto hostile = static_cast<std::uint8_t>(kHostile[below(kHostile.size())]);
    const auto at = bytes.begin() + place_in(bytes);
    const auto rest = static_cast<std::size_t>(bytes.end() - at);
    switch (below(6)) {
      case 0:  // insert something with a meaning
        bytes.insert(at, hostile);
        break;
      case 1:  // overwrite by it
        if (rest > 0) *at = hostile;
        break;
      case 2:  // overwrite by anything
        if (rest > 0) *at = static_cast<std::uint8_t>(below(256));
        break;
      case 3:  // delete a stretch
        bytes.erase(at, at + static_cast<std::ptrdiff_t>(std::min(rest, below(16))));
        break;
      case 4: {  // splice in a piece from elsewhere
        const Bytes piece = snippet();
        bytes.insert(at, piece.begin(), piece.end());
        break;
      }
      default:  // cut off
        if (below(4) == 0) bytes.erase(at, bytes.end());
        break;
    }
  }

  std::vector<Bytes> corpus_;
  std::mt19937 random_;
};

/// Keeps the input under test in a file: an abort or a signal leaves no chance to write it later.
class CrashFile {
 public:
  explicit CrashFile(fs::path path) : path_(std::move(path)), out_(path_, std::ios::binary) {}

  void hold(const Bytes& bytes) {
    out_.seekp(0);
    for (const std::uint8_t byte : bytes) out_.put(static_cast<char>(byte));
    out_.flush();
    fs::resize_file(path_, bytes.size());  // opening it anew each time costs milliseconds
  }
  void remove() { fs::remove(path_); }

 private:
  fs::path path_;
  std::ofstream out_;
};

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 4) {
    std::cerr << "usage: " << argv[0] << " CORPUS_DIR RUNS SEED\n";
    return 2;
  }
  const std::vector<Bytes> corpus = read_corpus(argv[1]);
  const long runs = std::stol(argv[2]);
  const auto seed = static_cast<unsigned>(std::stoul(argv[3]));
  if (corpus.empty()) {
    std::cerr << "no files in " << argv[1] << '\n';
    return 2;
  }
  std::cout << corpus.size() << " corpus files, " << runs << " mutations, seed " << seed << '\n';
  CrashFile crash("crash-" + fs::path(argv[0]).filename().string());
  const auto feed = [&](const Bytes& bytes) {
    crash.hold(bytes);
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  };
  for (const Bytes& bytes : corpus) feed(bytes);
  Mutator mutator(corpus, seed);
  for (long run = 0; run < runs; ++run) feed(mutator.next());
  crash.remove();
  return 0;
} catch (const std::exception& error) {
  std::cerr << argv[0] << ": uncaught: " << error.what() << '\n';
  return 1;
}
