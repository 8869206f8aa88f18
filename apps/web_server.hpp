#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

#include "apps/web_story.hpp"

namespace hopscotch::apps {

/// The page cannot be served, e.g. because the port is in use.
class WebUnavailable : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What a page may ask of a live run. Both get and give JSON; they are called on threads of the
/// server and throw std::invalid_argument with the reason on a malformed request.
struct WebDesk {
  std::function<std::string(const std::string& request)> propose;
  std::function<std::string(const std::string& request)> command;
};

inline constexpr int kWebPort = 8360;

/// Serves the page of one run to browsers on this machine, and to nobody else: it listens on
/// 127.0.0.1 only, and requests that another site's page sends are refused.
class WebServer {
 public:
  /// @param story, run_dir, desk  What is shown; `run_dir` may be empty, `desk` without functions.
  /// @throws WebUnavailable naming the port, or the page that was not built.
  WebServer(int port, const WebStory& story, const std::filesystem::path& run_dir, WebDesk desk);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  [[nodiscard]] std::string url() const;

 private:
  struct Connection;
  std::unique_ptr<Connection> connection_;
};

}  // namespace hopscotch::apps
