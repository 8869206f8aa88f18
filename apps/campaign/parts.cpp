#include "apps/campaign/parts.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>

#include "apps/campaign/engine.hpp"
#include "apps/text_file.hpp"
#include "core/config_reader.hpp"

namespace hopscotch::apps::campaign {

namespace fs = std::filesystem;

namespace {

/// First line of a part: what its results belong to.
std::string head_of(const StoreIdentity& identity) {
  return "hopscotch.part/1 " + identity.identity + " " + identity.program;
}

std::string stem_of(int round, int chunk) {
  return "round-" + std::to_string(round) + "-chunk-" + std::to_string(chunk);
}

/// Appends lines to a file of its own; each is there whole or not at all for the reader.
class PartWriter {
 public:
  explicit PartWriter(const fs::path& file)
      : file_(open(file.c_str(), O_CREAT | O_WRONLY | O_APPEND | O_CLOEXEC, 0644)) {
    if (file_ < 0) throw std::runtime_error("cannot write " + file.string());
  }
  ~PartWriter() { close(file_); }
  PartWriter(const PartWriter&) = delete;
  PartWriter& operator=(const PartWriter&) = delete;

  void add(const std::string& line) {
    const std::string text = line + "\n";
    const auto size = static_cast<ssize_t>(text.size());
    if (write(file_, text.data(), text.size()) != size || fsync(file_) != 0) {
      throw std::runtime_error(std::string("cannot write a part: ") + std::strerror(errno));
    }
  }

 private:
  int file_;
};

/// Whole lines of a file from a byte on; tells how far they reach.
std::vector<std::string> whole_lines(const fs::path& file, std::uintmax_t& from) {
  std::ifstream stream(file, std::ios::binary);
  stream.seekg(static_cast<std::streamoff>(from));
  std::ostringstream content;
  content << stream.rdbuf();
  const std::string text = content.str();
  std::vector<std::string> lines;
  std::size_t begin = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', begin)) {
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  from += begin;
  return lines;
}

std::pair<int, int> parse_name(const std::string& name) {
  int round = 0;
  int chunk = 0;
  const char* end = name.data() + name.size();
  const auto first = std::from_chars(name.data(), end, round);
  const bool slash = first.ec == std::errc() && first.ptr != end && *first.ptr == '/';
  const auto second = std::from_chars(slash ? first.ptr + 1 : end, end, chunk);
  if (!slash || second.ec != std::errc() || second.ptr != end) {
    throw core::ConfigError("--chunk = " + name + ", but must be ROUND/CHUNK");
  }
  return {round, chunk};
}

/// Trials of a chunk that earlier attempts at it have finished.
std::set<std::int64_t> finished_in(const fs::path& folder, const std::string& stem,
                                   const std::string& head) {
  std::set<std::int64_t> finished;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string file = entry.path().filename().string();
    if (!file.starts_with(stem + ".") || entry.path().extension() != ".part") continue;
    std::uintmax_t from = 0;
    const std::vector<std::string> lines = whole_lines(entry.path(), from);
    if (lines.empty() || lines.front() != head) continue;
    for (std::size_t i = 1; i < lines.size(); ++i) {
      finished.insert(result_from_line(lines[i]).index);
    }
  }
  return finished;
}

std::string host_name() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  return name.data();
}

}  // namespace

fs::path PartsFolder::chunk(int round, int chunk) const {
  return path / (stem_of(round, chunk) + ".trials");
}

void PartsFolder::write_round(int round,
                              const std::vector<std::vector<std::int64_t>>& chunks) const {
  fs::create_directories(path);
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    std::string text;
    for (const std::int64_t index : chunks[i]) text += std::to_string(index) + "\n";
    write_file_atomically(chunk(round, static_cast<int>(i)), text);
  }
}

std::vector<std::int64_t> PartsFolder::read_chunk(int round, int index) const {
  const fs::path file = chunk(round, index);
  if (!fs::is_regular_file(file)) throw core::ConfigError(file.string() + ": no such chunk");
  std::istringstream text(read_file(file));
  std::vector<std::int64_t> trials;
  for (std::int64_t trial = 0; text >> trial;) trials.push_back(trial);
  return trials;
}

void run_chunk(const TrialMaker& maker, const PartsFolder& folder, const std::string& name) {
  const auto [round, chunk] = parse_name(name);
  const std::vector<std::int64_t> trials = folder.read_chunk(round, chunk);
  const std::string head = head_of(identity_of(maker));
  const std::string stem = stem_of(round, chunk);
  const std::set<std::int64_t> finished = finished_in(folder.path, stem, head);
  PartWriter writer(folder.path / (stem + "." + host_name() + "-" + std::to_string(getpid()) + "-" +
                                   std::to_string(finished.size()) + ".part"));
  writer.add(head);
  std::vector<std::int64_t> open;
  for (const std::int64_t trial : trials) {
    if (!finished.contains(trial)) open.push_back(trial);
  }
  run_in_turn(maker, open, [&](const TrialResult& result) { writer.add(to_line(result)); });
}

void PartsReader::read_new(const std::function<void(const TrialResult&)>& visit) {
  if (!fs::is_directory(folder_.path)) return;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_.path)) {
    if (entry.path().extension() != ".part") continue;
    std::uintmax_t& from = read_[entry.path()];
    if (entry.file_size() <= from) continue;
    const bool begin = from == 0;
    std::vector<std::string> lines = whole_lines(entry.path(), from);
    if (begin && !lines.empty()) {
      if (lines.front() != head_of(identity_)) {
        throw core::ConfigError(entry.path().string() + ": is of another campaign or program (" +
                                lines.front() + ")");
      }
      lines.erase(lines.begin());
    }
    for (const std::string& line : lines) visit(result_from_line(line));
  }
}

}  // namespace hopscotch::apps::campaign
