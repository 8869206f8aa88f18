#include "apps/campaign/worker_pool.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <map>
#include <stdexcept>

namespace hopscotch::apps::campaign {
namespace {

constexpr double kLong = 60.0;  // [s] never reached

std::map<std::int64_t, WorkerAnswer> run_jobs(WorkerPool& pool, std::int64_t jobs) {
  std::map<std::int64_t, WorkerAnswer> answers;
  std::int64_t next = 0;
  while (next < jobs || !pool.idle()) {
    while (next < jobs && pool.has_room()) pool.start(next++);
    for (const WorkerAnswer& answer : pool.wait(1.0)) answers[answer.job] = answer;
  }
  return answers;
}

TEST(WorkerPool, BringsBackWhatEachJobReturned) {
  const std::string padding(200'000, 'x');  // more than a pipe holds
  WorkerPool pool(3, kLong, [&](std::int64_t job) { return padding + std::to_string(job); });
  const auto answers = run_jobs(pool, 10);
  ASSERT_EQ(answers.size(), 10U);
  for (const auto& [job, answer] : answers) {
    EXPECT_EQ(answer.end, WorkerEnd::answered);
    EXPECT_EQ(answer.text, padding + std::to_string(job));
  }
}

TEST(WorkerPool, ACrashIsTheJobsOwn) {
  WorkerPool pool(2, kLong, [](std::int64_t job) -> std::string {
    if (job == 1) std::raise(SIGKILL);
    if (job == 2) throw std::runtime_error("no such terrain");
    if (job == 3) _exit(0);  // without an answer
    return "fine";
  });
  const auto answers = run_jobs(pool, 5);
  EXPECT_EQ(answers.at(0).end, WorkerEnd::answered);
  EXPECT_EQ(answers.at(1).end, WorkerEnd::crashed);
  EXPECT_EQ(answers.at(1).text, "Killed");
  EXPECT_EQ(answers.at(2).end, WorkerEnd::failed);
  EXPECT_EQ(answers.at(2).text, "no such terrain");
  EXPECT_EQ(answers.at(3).end, WorkerEnd::crashed);
  EXPECT_EQ(answers.at(4).end, WorkerEnd::answered);
}

TEST(WorkerPool, AHangIsBoundedAndMarked) {
  WorkerPool pool(2, 0.3, [](std::int64_t job) -> std::string {
    while (job == 0) pause();
    return "fine";
  });
  const auto answers = run_jobs(pool, 2);
  EXPECT_EQ(answers.at(0).end, WorkerEnd::hung);
  EXPECT_EQ(answers.at(1).end, WorkerEnd::answered);
}

TEST(WorkerPool, WorkersIgnoreCtrlCAndEndWithThePool) {
  pid_t worker = 0;
  {
    WorkerPool pool(1, kLong, [](std::int64_t) {
      std::raise(SIGINT);
      return std::to_string(getpid());
    });
    const auto answers = run_jobs(pool, 1);
    ASSERT_EQ(answers.at(0).end, WorkerEnd::answered);
    worker = std::stoi(answers.at(0).text);
  }
  EXPECT_EQ(kill(worker, 0), -1);
  WorkerPool pool(1, kLong, [](std::int64_t) -> std::string {
    while (true) pause();
  });
  pool.start(0);
  pool.kill_all();
  EXPECT_TRUE(pool.idle());
}

}  // namespace
}  // namespace hopscotch::apps::campaign
