#include "apps/web_server.hpp"

#include <httplib.h>
#include <sys/socket.h>

#include <charconv>
#include <thread>
#include <utility>

#include "apps/installation.hpp"
#include "apps/web_json.hpp"

namespace hopscotch::apps {

namespace {

constexpr const char* kHost = "127.0.0.1";
constexpr const char* kJson = "application/json";
/// A browser adds a header of that name to no request of its own accord, and asks before it lets
/// another site's page do so: such requests come from our page.
constexpr const char* kOwnHeader = "X-Hopscotch";

std::size_t count_in(const httplib::Request& request, const char* name) {
  const std::string text = request.get_param_value(name);
  std::size_t count = 0;
  std::from_chars(text.data(), text.data() + text.size(), count);
  return count;
}

void refuse(httplib::Response& response, int status, const std::string& why) {
  response.status = status;
  response.set_content("{\"error\":" + quoted_json(why) + "}", kJson);
}

using Answerer = std::function<std::string(const std::string&)>;

void answer(const Answerer& answerer, const httplib::Request& request,
            httplib::Response& response) {
  constexpr std::size_t kMostBytes = 4096;
  if (!answerer) return refuse(response, 409, "this run is over: nothing to ask it");
  if (!request.has_header(kOwnHeader)) return refuse(response, 403, "not sent by our page");
  if (request.body.size() > kMostBytes) return refuse(response, 413, "the request is too long");
  try {
    response.set_content(answerer(request.body), kJson);
  } catch (const std::invalid_argument& error) {
    refuse(response, 400, error.what());
  }
}

}  // namespace

struct WebServer::Connection {
  Connection(int wanted_port, const WebStory& the_story, WebDesk the_desk)
      : port(wanted_port), story(the_story), desk(std::move(the_desk)) {}

  /// A page of another site that resolves its own name to this machine would send that name.
  [[nodiscard]] bool is_local(const httplib::Request& request) const {
    const std::string host = request.get_header_value("Host");
    const std::string at_port = ":" + std::to_string(port);
    return host == kHost + at_port || host == "localhost" + at_port;
  }

  void route() {
    server.set_pre_routing_handler([this](const auto& request, auto& response) {
      if (is_local(request)) return httplib::Server::HandlerResponse::Unhandled;
      refuse(response, 403, "only for this machine");
      return httplib::Server::HandlerResponse::Handled;
    });
    server.set_default_headers({{"Cache-Control", "no-store"},
                                {"Content-Security-Policy",
                                 "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src "
                                 "'self' data:"}});
    server.Get("/api/about",
               [this](const auto&, auto& response) { response.set_content(story.about(), kJson); });
    server.Get("/api/since", [this](const auto& request, auto& response) {
      response.set_content(story.since(count_in(request, "frame"), count_in(request, "happening")),
                           kJson);
    });
    server.Post("/api/propose", [this](const auto& request, auto& response) {
      answer(desk.propose, request, response);
    });
    server.Post("/api/command", [this](const auto& request, auto& response) {
      answer(desk.command, request, response);
    });
  }

  int port;
  const WebStory& story;
  WebDesk desk;
  httplib::Server server;
  std::thread thread;
};

WebServer::WebServer(int port, const WebStory& story, const std::filesystem::path& run_dir,
                     WebDesk desk)
    : connection_(std::make_unique<Connection>(port, story, std::move(desk))) {
  httplib::Server& server = connection_->server;
  const std::filesystem::path page = page_directory();
  if (!server.set_mount_point("/", page.string())) {
    throw WebUnavailable("the page is not built: " + page.string() + " is missing (make build)");
  }
  if (!run_dir.empty()) server.set_mount_point("/run", run_dir.string());
  // Not the library's choice of SO_REUSEPORT, with which two programs can have one port.
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  connection_->route();
  if (port == 0) connection_->port = server.bind_to_any_port(kHost);
  if (connection_->port <= 0 || (port != 0 && !server.bind_to_port(kHost, port))) {
    throw WebUnavailable("port " + std::to_string(port) +
                         " is in use on this machine: give another with --port");
  }
  connection_->thread = std::thread([&server] { server.listen_after_bind(); });
}

WebServer::~WebServer() {
  connection_->server.stop();
  connection_->thread.join();
}

std::string WebServer::url() const {
  return std::string("http://") + kHost + ":" + std::to_string(connection_->port) + "/";
}

}  // namespace hopscotch::apps
