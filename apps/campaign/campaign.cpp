#include "apps/campaign/campaign.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cstdio>

#include "apps/campaign/analysis.hpp"
#include "apps/campaign/campaign_report.hpp"
#include "apps/campaign/comparison.hpp"
#include "apps/campaign/trial_run.hpp"
#include "apps/campaign/worker_pool.hpp"
#include "apps/text_file.hpp"

namespace hopscotch::apps::campaign {

namespace fs = std::filesystem;

namespace {

std::vector<std::int64_t> worth_keeping(const Analysis& analysis, const KeepRule& rule) {
  std::vector<std::int64_t> kept;
  const auto take = [&](const std::vector<std::int64_t>& from, int most) {
    for (std::size_t i = 0; i < from.size() && i < static_cast<std::size_t>(most); ++i) {
      kept.push_back(from[i]);
    }
  };
  for (const FailureClass& failure : analysis.failures) take(failure.examples, rule.failures);
  take(analysis.successes, rule.successes);
  return kept;
}

}  // namespace

FolderLock::FolderLock(const CampaignFolder& folder) {
  fs::create_directories(folder.path);
  file_ = open(folder.lock().c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644);
  if (file_ < 0) throw std::runtime_error("cannot write " + folder.lock().string());
  if (flock(file_, LOCK_EX | LOCK_NB) != 0) {
    close(file_);
    throw core::ConfigError(folder.path.string() + ": another process runs a campaign here");
  }
}

FolderLock::~FolderLock() {
  close(file_);
}

void skip_finished(const Store& store, TrialQueue& queue) {
  store.for_each(Store::Paths::without, [&](const TrialResult& row) {
    queue.finished(row.index,
                   row.succeeded() ? TrialQueue::Verdict::success : TrialQueue::Verdict::failure);
  });
}

void keep_runs(const TrialMaker& maker, int jobs, const CampaignFolder& folder,
               const Store& store) {
  WorkerPool pool(jobs, maker.spec().trial_timeout, [&](std::int64_t index) {
    return std::string(run_outcome_name(record_trial(maker, index, folder.run(index)).outcome));
  });
  const auto receive = [&] {
    for (const WorkerAnswer& answer : pool.wait(1.0)) {
      const std::string expected = store.find(answer.job).value().outcome;
      const bool same = answer.end == WorkerEnd::answered && answer.text == expected;
      if (same || expected == "crashed" || expected == "hung") continue;
      std::fprintf(stderr, "hopscotch: trial %lld was \"%s\" and ends otherwise when run again%s\n",
                   static_cast<long long>(answer.job), expected.c_str(),
                   answer.text.empty() ? "" : (": " + answer.text).c_str());
    }
  };
  for (const std::int64_t index : worth_keeping(analyse(store), maker.spec().keep)) {
    if (Interrupts::count() > 0) break;
    if (fs::exists(folder.run(index))) continue;
    while (!pool.has_room()) receive();
    pool.start(index);
  }
  while (!pool.idle() && Interrupts::count() < 2) receive();
}

void compare_with(const fs::path& other, Store& store) {
  const Store theirs(CampaignFolder{other}.store());
  (void)compare(store, theirs);  // what cannot be compared is refused before anything is run
  store.set_note("compared_with", fs::absolute(other).string());
}

void write_results(const CampaignFolder& folder) {
  const Store store(folder.store());
  const Analysis analysis = analyse(store);
  ReportContent content{folder, analysis, campaign_figures(analysis, store), std::nullopt};
  const CampaignFolder other{store.note("compared_with")};
  if (!other.path.empty() && fs::exists(other.store())) {
    content.comparison = compare(store, Store(other.store()));
    write_file_atomically(folder.comparison(),
                          comparison_json(*content.comparison, analysis.identity.factors));
  }
  fs::create_directories(folder.figures());
  for (const NamedFigure& figure : content.figures) {
    write_file_atomically(folder.figures() / (figure.name + ".svg"), figure.svg);
  }
  write_file_atomically(folder.table(), trials_csv(store));
  write_file_atomically(folder.cells(), cells_csv(analysis));
  write_file_atomically(folder.report(), report_page(content));
  write_file_atomically(folder.summary(), summary_json(analysis));
}

}  // namespace hopscotch::apps::campaign
