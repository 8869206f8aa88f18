#include "apps/campaign/worker_pool.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <stdexcept>

namespace hopscotch::apps::campaign {

namespace {

constexpr char kAnswered = 'A';  // first byte of a stream; the last one is the same
constexpr char kFailed = 'F';

double now() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

bool write_all(int file, const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t n = write(file, text.data() + done, text.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return true;
}

}  // namespace

WorkerPool::WorkerPool(int size, double timeout, Work work)
    : size_(static_cast<std::size_t>(size)), timeout_(timeout), work_(std::move(work)) {}

WorkerPool::~WorkerPool() {
  kill_all();
}

void WorkerPool::start(std::int64_t job) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw std::runtime_error(std::string("no pipe for a worker: ") + std::strerror(errno));
  }
  const pid_t parent = getpid();
  const pid_t process = fork();
  if (process < 0) {
    close(ends[0]);
    close(ends[1]);
    throw std::runtime_error(std::string("no process for a worker: ") + std::strerror(errno));
  }
  if (process == 0) {
    close(ends[0]);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(1);  // it died before it could be bound to
    be_worker(job, ends[1]);
  }
  close(ends[1]);
  workers_.push_back(
      {.process = process, .pipe = ends[0], .job = job, .deadline = now() + timeout_, .text = {}});
}

void WorkerPool::be_worker(std::int64_t job, int pipe) const {
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGTERM, SIG_DFL);
  for (const Worker& sibling : workers_) close(sibling.pipe);
  std::string text;
  try {
    text = kAnswered + work_(job);
  } catch (const std::exception& error) {
    text = kFailed + std::string(error.what());
  }
  const bool told = write_all(pipe, text + text.front());
  _exit(told ? 0 : 1);  // no destructors: they belong to the parent
}

bool WorkerPool::read_some(Worker& worker) {
  std::array<char, 16384> block{};
  const ssize_t n = read(worker.pipe, block.data(), block.size());
  if (n < 0) return errno == EINTR || errno == EAGAIN;
  worker.text.append(block.data(), static_cast<std::size_t>(n));
  return n > 0;
}

WorkerAnswer WorkerPool::bury(Worker& worker) {
  close(worker.pipe);
  int status = 0;
  while (waitpid(worker.process, &status, 0) < 0 && errno == EINTR) {
  }
  const std::string& text = worker.text;
  const bool whole = text.size() >= 2 && text.front() == text.back() && WIFEXITED(status) &&
                     WEXITSTATUS(status) == 0;
  WorkerAnswer answer{.job = worker.job, .end = WorkerEnd::crashed, .text = {}};
  if (whole) {
    answer.end = text.front() == kAnswered ? WorkerEnd::answered : WorkerEnd::failed;
    answer.text = text.substr(1, text.size() - 2);
  } else if (worker.overdue) {
    answer.end = WorkerEnd::hung;
  } else if (WIFSIGNALED(status)) {
    answer.text = strsignal(WTERMSIG(status));
  } else {
    answer.text = "exit status " + std::to_string(WEXITSTATUS(status));
  }
  return answer;
}

std::vector<WorkerAnswer> WorkerPool::wait(double seconds) {
  constexpr double kMillisecond = 1e3;
  std::vector<pollfd> files;
  double patience = seconds;
  for (const Worker& worker : workers_) {
    files.push_back({.fd = worker.pipe, .events = POLLIN, .revents = 0});
    patience = std::min(patience, std::max(0.0, worker.deadline - now()));
  }
  if (poll(files.data(), files.size(), static_cast<int>(kMillisecond * patience) + 1) < 0) {
    return {};  // a signal: the caller looks what it meant
  }
  std::vector<WorkerAnswer> answers;
  std::vector<Worker> alive;
  for (std::size_t i = 0; i < workers_.size(); ++i) {
    Worker& worker = workers_[i];
    if (!worker.overdue && now() > worker.deadline) {
      worker.overdue = true;
      kill(worker.process, SIGKILL);
    }
    const bool open = files[i].revents == 0 || read_some(worker);
    if (open) {
      alive.push_back(std::move(worker));
    } else {
      answers.push_back(bury(worker));
    }
  }
  workers_ = std::move(alive);
  return answers;
}

void WorkerPool::kill_all() {
  for (Worker& worker : workers_) kill(worker.process, SIGKILL);
  for (Worker& worker : workers_) (void)bury(worker);
  workers_.clear();
}

}  // namespace hopscotch::apps::campaign
