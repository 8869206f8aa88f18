#pragma once

#include <cstdint>
#include <string>

#include "apps/live_run.hpp"
#include "apps/lockstep_run.hpp"
#include "apps/proposal_desk.hpp"
#include "apps/web_server.hpp"
#include "apps/web_story.hpp"
#include "msgs/dispatcher.hpp"
#include "msgs/event.hpp"

namespace hopscotch::apps {

/// The page of a run that is on.
class WebRun {
 public:
  /// @param box Gets the commands that are given on the page; outlives this object.
  /// @throws WebUnavailable
  WebRun(int port, std::uint64_t run_id, const RunRequest& request, CommandBox& box);

  [[nodiscard]] std::string url() const { return server_.url(); }

  /// In the loop of the run: every event, and once a tick.
  void show(const msgs::Event& event);
  void attend(const LockstepRun& run) { proposals_.serve(run); }
  /// The run is over; waits a moment for open pages to fetch the rest.
  void finish(const std::string& result_json);

 private:
  WebStory story_;
  msgs::Dispatcher dispatcher_;
  ProposalDesk proposals_;
  WebServer server_;  ///< Last: its threads use the others.
};

/// A command from the page: `{"mode": "hold"}`, `{"clear": true}` or `{"target": {"distance",
/// "lateral", "yaw"}}`, addressed to `run_id` and dated now.
/// @throws std::invalid_argument naming what is wrong.
[[nodiscard]] core::OperatorCommand page_command(const std::string& request, std::uint64_t run_id);

}  // namespace hopscotch::apps
