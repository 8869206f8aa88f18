#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace hopscotch::apps::campaign {

/// How a worker ended.
enum class WorkerEnd : std::uint8_t {
  answered,  ///< `text` is what the work returned.
  failed,    ///< The work threw; `text` is what it said.
  crashed,   ///< A signal ended it; `text` says which.
  hung,      ///< It was killed after the time limit.
};

struct WorkerAnswer {
  std::int64_t job = 0;
  WorkerEnd end = WorkerEnd::answered;
  std::string text;
};

/// Child processes of this one, each with one job: a crash or a hang is the job's own, and memory
/// is given back after each. To be used from a process with one thread, since it forks. Workers
/// do not outlive this process, ignore the terminal's Ctrl-C and die with the pool.
class WorkerPool {
 public:
  /// What a worker does for a job; runs in the child.
  using Work = std::function<std::string(std::int64_t)>;

  /// @param size    Workers at a time.
  /// @param timeout Wall time that a job may take [s].
  WorkerPool(int size, double timeout, Work work);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  [[nodiscard]] bool has_room() const { return workers_.size() < size_; }
  [[nodiscard]] bool idle() const { return workers_.empty(); }

  /// @pre has_room()
  /// @throws std::runtime_error if the system gives no process.
  void start(std::int64_t job);

  /// Waits at most so long for workers to end [s]; returns early at a signal.
  [[nodiscard]] std::vector<WorkerAnswer> wait(double seconds);

  /// Ends all workers at once; their jobs are lost.
  void kill_all();

 private:
  struct Worker {
    pid_t process;
    int pipe;
    std::int64_t job;
    double deadline;  ///< On the monotonic clock [s].
    std::string text;
    bool overdue = false;
  };

  [[noreturn]] void be_worker(std::int64_t job, int pipe) const;
  /// Reads what is there; false at the end of the stream.
  static bool read_some(Worker& worker);
  static WorkerAnswer bury(Worker& worker);

  std::size_t size_;
  double timeout_;
  Work work_;
  std::vector<Worker> workers_;
};

}  // namespace hopscotch::apps::campaign
