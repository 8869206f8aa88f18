// A cluster of three nodes on this machine. Each node lives in a process namespace of its own, so
// that killing it kills all that runs on it, as the death of a machine does.
#include <gtest/gtest.h>

#include <memory>

#include "apps/campaign/external_command.hpp"
#include "apps/campaign/store.hpp"
#include "tests/scenario/campaign_folder.hpp"

namespace hopscotch::tests {
namespace {

using apps::campaign::call;
using apps::campaign::Store;

constexpr double kPatience = 20.0;  // [s] of a client call
constexpr int kNodes = 3;

std::string short_host_name() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  const std::string text = name.data();
  return text.substr(0, text.find('.'));
}

class Cluster {
 public:
  explicit Cluster(const TestFolder& folder) : folder_(folder) {
    for (const char* name : {"state", "spool", "log", "run"}) {
      fs::create_directories(folder.path() / name);
    }
    const fs::path file = folder.write("slurm.conf", configuration());
    setenv("SLURM_CONF", file.c_str(), 1);
    controller_ = std::make_unique<Process>(
        std::vector<std::string>{"slurmctld", "-f", file.string(), "-c", "-D"},
        folder.path() / "log/controller.out");
    for (int node = 1; node <= kNodes; ++node) start(node);
  }
  ~Cluster() {
    // Killing the namespace's first process ends everything in it.
    for (auto& node : nodes_) node.reset();
  }

  void start(int node) {
    const std::string name = "n" + std::to_string(node);
    nodes_[static_cast<std::size_t>(node - 1)] = std::make_unique<Process>(
        std::vector<std::string>{"unshare", "--pid", "--fork", "--kill-child", "--mount-proc",
                                 "slurmd", "-f", (folder_.path() / "slurm.conf").string(), "-N",
                                 name, "-D"},
        folder_.path() / ("log/" + name + ".out"));
  }

  /// The node dies; the controller is told, since noticing by itself takes it half a minute.
  void kill_node(int node) {
    nodes_[static_cast<std::size_t>(node - 1)].reset();
    (void)call(
        {"scontrol", "update", "nodename=n" + std::to_string(node), "state=down", "reason=killed"},
        kPatience);
  }

  [[nodiscard]] static bool all_idle() {
    const auto answer = call({"sinfo", "--noheader", "--format", "%t %D"}, kPatience);
    return answer.status == 0 && answer.output == "idle " + std::to_string(kNodes) + "\n";
  }
  [[nodiscard]] static bool runs_on(int node) {
    const auto answer = call({"squeue", "--noheader", "--states", "R", "--nodelist",
                              "n" + std::to_string(node), "--format", "%i"},
                             kPatience);
    return answer.status == 0 && !answer.output.empty();
  }

 private:
  [[nodiscard]] std::string configuration() const {
    const std::string host = short_host_name();
    const std::string place = folder_.path().string();
    const int port = 20'000 + 10 * (getpid() % 2'000);
    std::string text =
        "ClusterName=test\nSlurmctldHost=" + host +
        "(127.0.0.1)\nSlurmctldPort=" + std::to_string(port) +
        "\nSlurmUser=root\nSlurmdUser=root\nAuthType=auth/none\nCredType=cred/none\n"
        "AuthInfo=cred_expire=5\nProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\n"
        "SwitchType=switch/none\nMpiDefault=none\nAccountingStorageType=accounting_storage/none\n"
        "JobAcctGatherType=jobacct_gather/none\nSelectType=select/cons_tres\n"
        "SelectTypeParameters=CR_Core\nSchedulerType=sched/backfill\n"
        "SchedulerParameters=sched_min_interval=0,batch_sched_delay=0,bf_interval=1\n"
        "SlurmdTimeout=5\nSlurmctldTimeout=10\nKillWait=1\nReturnToService=2\nJobRequeue=1\n"
        "SlurmdParameters=config_overrides\nMaxArraySize=20001\n"
        "StateSaveLocation=" +
        place + "/state\nSlurmdSpoolDir=" + place + "/spool/%n\nSlurmctldPidFile=" + place +
        "/run/controller.pid\nSlurmdPidFile=" + place + "/run/%n.pid\nSlurmctldLogFile=" + place +
        "/log/controller.log\nSlurmdLogFile=" + place + "/log/%n.log\n";
    for (int node = 1; node <= kNodes; ++node) {
      text += "NodeName=n" + std::to_string(node) + " NodeHostname=" + host +
              " NodeAddr=127.0.0.1 Port=" + std::to_string(port + node) +
              " CPUs=2 RealMemory=2000 State=UNKNOWN\n";
    }
    return text + "PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP\n";
  }

  const TestFolder& folder_;
  std::unique_ptr<Process> controller_;
  std::array<std::unique_ptr<Process>, kNodes> nodes_;
};

std::int64_t rows_of(const fs::path& out) {
  std::int64_t count = 0;
  try {
    Store(out / "trials.sqlite").for_each(Store::Paths::without, [&](const auto&) { ++count; });
  } catch (const std::exception&) {  // not begun yet
  }
  return count;
}

TEST(Slurm, ADeadNodeAndADeadParentEndWithTheStoreOfOneMachine) {
  const TestFolder folder("slurm");
  const fs::path spec = folder.write("short.yaml", short_campaign(12));
  const fs::path log = folder.path() / "campaign.log";
  const fs::path local = folder.path() / "local";
  const fs::path out = folder.path() / "out";
  const auto words = [&](const fs::path& into, const std::vector<std::string>& more) {
    std::vector<std::string> result{HOPSCOTCH_PROGRAM, "campaign", spec.string(), "--out",
                                    into.string()};
    result.insert(result.end(), more.begin(), more.end());
    return result;
  };
  Cluster cluster(folder);
  ASSERT_TRUE(eventually(Cluster::all_idle)) << text_of(folder.path() / "log/controller.log");
  {
    Process campaign(words(out, {"--engine", "slurm"}), log);
    ASSERT_TRUE(eventually([&] { return rows_of(out) >= 2 && Cluster::runs_on(2); }))
        << text_of(log);
    cluster.kill_node(2);
    campaign.send(SIGKILL);
    EXPECT_EQ(campaign.wait(), 128 + SIGKILL);
  }
  ASSERT_LT(rows_of(out), 24);
  ASSERT_EQ(Process(words(out, {"--engine", "slurm", "--resume"}), log).wait(), 0) << text_of(log);
  EXPECT_NE(text_of(log).find("goes on with job"), std::string::npos) << text_of(log);
  EXPECT_EQ(rows_of(out), 24);
  ASSERT_EQ(Process(words(local, {"--jobs", "2"}), log).wait(), 0) << text_of(log);
  EXPECT_EQ(text_of(out / "trials.csv"), text_of(local / "trials.csv"));
}

TEST(Slurm, WithoutAControllerTheCampaignEndsAndSaysSo) {
  const TestFolder folder("no-slurm");
  const fs::path spec = folder.write("short.yaml", short_campaign(1));
  setenv("SLURM_CONF", folder.write("slurm.conf", "ClusterName=none\n").c_str(), 1);
  const fs::path log = folder.path() / "log";
  const std::vector<std::string> words{
      HOPSCOTCH_PROGRAM, "campaign", spec.string(), "--out", (folder.path() / "out").string(),
      "--engine",        "slurm"};
  EXPECT_EQ(Process(words, log).wait(), 3);
  EXPECT_NE(text_of(log).find("sbatch"), std::string::npos) << text_of(log);
}

}  // namespace
}  // namespace hopscotch::tests
