#include <cstdio>
#include <filesystem>
#include <memory>

#include "apps/campaign/campaign.hpp"
#include "apps/commands.hpp"
#include "apps/report.hpp"
#include "apps/run_folder.hpp"

namespace hopscotch::apps {

void add_report_command(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("report", "(Re)writes report.html of a run or campaign folder");
  command->footer("Example: hopscotch report runs/flat-leaps-1");
  const auto folder = std::make_shared<std::filesystem::path>();  // shared with the action below
  command->add_option("DIR", *folder, "Run or campaign folder")->required();
  command->callback([&action, folder] {
    action = [folder] {
      const campaign::CampaignFolder campaign{*folder};
      if (std::filesystem::is_regular_file(campaign.store())) {
        campaign::write_results(campaign);
        std::printf("%s\n", campaign.report().c_str());
        return ExitStatus::ok;
      }
      require_run_folder({*folder});
      write_report(*folder);
      std::printf("%s\n", (*folder / "report.html").c_str());
      return ExitStatus::ok;
    };
  });
}

}  // namespace hopscotch::apps
