#include "apps/text_file.hpp"

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>

namespace hopscotch::apps {

std::string read_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream content;
  // An empty file is read too; putting no character would count as a failure.
  if (stream.peek() != std::ifstream::traits_type::eof()) content << stream.rdbuf();
  const bool whole = stream.is_open() && !stream.bad() && !content.fail();
  if (!whole) throw std::runtime_error("cannot read " + file.string());
  return content.str();
}

void write_file_atomically(const std::filesystem::path& file, std::string_view content) {
  std::filesystem::path beside = file;
  beside += ".part";
  std::ofstream stream(beside, std::ios::binary | std::ios::trunc);
  stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  stream.close();
  std::error_code error;
  if (stream) std::filesystem::rename(beside, file, error);
  if (!stream || error) {
    std::error_code ignored;  // the first error is the one to report
    std::filesystem::remove(beside, ignored);
    throw std::runtime_error("cannot write " + file.string());
  }
}

}  // namespace hopscotch::apps
