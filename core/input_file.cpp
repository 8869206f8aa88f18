#include "core/input_file.hpp"

#include <array>
#include <cstdio>
#include <memory>
#include <system_error>

namespace hopscotch::core {

std::string read_input_file(const std::filesystem::path& file, std::uintmax_t size_max) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) throw ConfigError(file.string() + ": no such file");
  if (!std::filesystem::is_regular_file(file, error)) {
    throw ConfigError(file.string() + ": is no regular file");
  }
  if (std::filesystem::file_size(file, error) > size_max << 20U) {
    throw ConfigError(file.string() + ": is larger than " + std::to_string(size_max) + " MiB");
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rb"),
                                                               std::fclose);
  if (!stream) throw ConfigError(file.string() + ": cannot be read");
  std::string text;
  std::array<char, 65536> block{};
  for (std::size_t n = 0; (n = std::fread(block.data(), 1, block.size(), stream.get())) > 0;) {
    text.append(block.data(), n);
  }
  if (std::ferror(stream.get()) != 0) throw ConfigError(file.string() + ": cannot be read");
  return text;
}

std::string read_plain_name(const ConfigReader& reader, std::string_view key) {
  constexpr std::size_t kLongest = 100;
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.";
  std::string name = reader.text(key);
  const bool plain = !name.empty() && name.size() <= kLongest && name.front() != '.' &&
                     name.find_first_not_of(kPlain) == std::string::npos;
  if (!plain) {
    reader.reject(key,
                  "it names folders: 1 to 100 letters, digits, '-', '_' or '.', not '.' first");
  }
  return name;
}

}  // namespace hopscotch::core
