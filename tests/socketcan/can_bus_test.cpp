// CanBus on a kernel that has CAN: runs in the guest that `in_user_mode_linux` starts.
#include "hardware/can_bus.hpp"

#include <gtest/gtest.h>
#include <poll.h>
#include <sched.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <memory>
#include <thread>
#include <vector>

#include "hardware/drive_map.hpp"
#include "hardware/emulated_drive.hpp"

namespace hopscotch::hardware {
namespace {

const std::string kConfigFolder = std::string(HOPSCOTCH_SOURCE_DIR) + "/config/";

BusTopology shipped_topology() {
  return BusTopology::load(core::ConfigReader::from_file(kConfigFolder + "robot_bus.yaml"),
                           kConfigFolder + "drives");
}

/// Everything that comes within `timeout_ms`.
std::vector<CanEvent> receive_all(CanBus& bus, int timeout_ms = 50) {
  std::vector<CanEvent> all;
  std::array<CanEvent, CanBus::kBatch> events;
  pollfd waited{.fd = bus.descriptor(), .events = POLLIN, .revents = 0};
  while (poll(&waited, 1, timeout_ms) > 0) {
    const std::size_t count = bus.receive(events);
    all.insert(all.end(), events.begin(), events.begin() + static_cast<std::ptrdiff_t>(count));
  }
  return all;
}

CanFrame frame(std::uint32_t id, std::uint8_t first) {
  CanFrame frame{.id = id, .size = 8};
  frame.data = {first, 2, 3, 4, 5, 6, 7, 8};
  return frame;
}

TEST(SocketCan, BatchArrivesInOrderWithKernelTimestamps) {
  CanBus host({.interface_name = "can0", .identifiers = {0x21}});
  CanBus drive({.interface_name = "can0", .identifiers = {1, 2, 3}});
  const std::array<CanFrame, 3> sent{frame(1, 10), frame(2, 20), frame(3, 30)};
  EXPECT_EQ(host.send(sent), 3U);
  const std::vector<CanEvent> got = receive_all(drive);
  ASSERT_EQ(got.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(got[i].kind, CanEvent::Kind::received);
    EXPECT_EQ(got[i].frame.id, sent[i].id);
    EXPECT_EQ(got[i].frame.data, sent[i].data);
    EXPECT_GT(got[i].stamp.nanoseconds, 1'000'000'000'000'000'000);  // after 2001
  }
  EXPECT_LE(got[0].stamp, got[2].stamp);
}

TEST(SocketCan, FiltersLetOnlyTheirIdentifiersThrough) {
  CanBus host({.interface_name = "can0", .identifiers = {0x21}});
  CanBus drive({.interface_name = "can0", .identifiers = {5}});
  for (std::uint32_t id = 0; id < 10; ++id) {
    const CanFrame one = frame(id, 0);
    ASSERT_EQ(host.send({&one, 1}), 1U);
  }
  const std::vector<CanEvent> got = receive_all(drive);
  ASSERT_EQ(got.size(), 1U);
  EXPECT_EQ(got[0].frame.id, 5U);
}

TEST(SocketCan, OwnFramesAreConfirmedAndForeignOnesAreNot) {
  CanBus host({.interface_name = "can0", .identifiers = {1, 0x21}});
  CanBus second({.interface_name = "can0", .identifiers = {0x21}});
  const CanFrame command = frame(1, 0);
  host.send({&command, 1});
  second.send({&command, 1});  // a second host on the bus
  const std::vector<CanEvent> got = receive_all(host);
  ASSERT_EQ(got.size(), 2U);
  EXPECT_EQ(got[0].kind, CanEvent::Kind::confirmed);
  EXPECT_EQ(got[1].kind, CanEvent::Kind::received);
  EXPECT_EQ(host.counters().confirmed, 1U);
}

TEST(SocketCan, BusOffArrivesAsAnError) {
  CanBus host({.interface_name = "can1", .identifiers = {1}});
  CanBus drive({.interface_name = "can1", .identifiers = {1}});
  ASSERT_TRUE(drive.send_bus_off());
  const std::vector<CanEvent> got = receive_all(host);
  ASSERT_EQ(got.size(), 1U);
  EXPECT_EQ(got[0].kind, CanEvent::Kind::error);
  EXPECT_TRUE(got[0].errors.bus_off);
}

TEST(SocketCan, FlexibleDataRateFramesGoBothWays) {
  CanBus host({.interface_name = "can2", .identifiers = {0x21}, .flexible_data_rate = true});
  CanBus drive({.interface_name = "can2", .identifiers = {1}, .flexible_data_rate = true});
  CanBus classical({.interface_name = "can2", .identifiers = {1}});
  const CanFrame command = frame(1, 77);
  EXPECT_EQ(host.send({&command, 1}), 1U);
  const std::vector<CanEvent> got = receive_all(drive);
  ASSERT_EQ(got.size(), 1U);
  EXPECT_EQ(got[0].frame.data, command.data);
  EXPECT_TRUE(receive_all(classical).empty());
}

TEST(SocketCan, FloodIsDroppedByTheKernelAndCounted) {
  CanBus host({.interface_name = "can3", .identifiers = {0x21}});
  CanBus drive({.interface_name = "can3", .identifiers = {1}});
  std::vector<CanFrame> frames(CanBus::kBatch, frame(1, 0));
  for (int i = 0; i < 1000; ++i) host.send(frames);
  const std::size_t got = receive_all(drive).size();
  const CanFrame last = frame(1, 0);
  host.send({&last, 1});
  static_cast<void>(receive_all(drive));
  EXPECT_LT(got, 32000U);
  EXPECT_EQ(got + drive.counters().dropped, 32000U);
}

TEST(SocketCan, MissingInterfaceIsNamedWithTheFix) {
  try {
    const CanBus bus({.interface_name = "can9", .identifiers = {1}});
    FAIL() << "opened";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("can9: no such CAN interface; fix: ip link set can9"),
              std::string::npos)
        << error.what();
  }
}

TEST(SocketCan, InterfaceThatIsDownTakesNothing) {
  CanBus host({.interface_name = "can3", .identifiers = {1}});
  ASSERT_EQ(std::system("ip link set can3 down"), 0);
  const CanFrame command = frame(1, 0);
  EXPECT_EQ(host.send({&command, 1}), 0U);
  EXPECT_EQ(host.counters().refused, 1U);
  ASSERT_EQ(std::system("ip link set can3 up"), 0);
}

double now_us() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

/// Both ends of the shipped four buses.
struct TenDrives {
  BusTopology topology = shipped_topology();
  std::vector<CanBus> hosts;
  std::vector<CanBus> far_ends;
  std::vector<EmulatedDrive> drives;

  TenDrives() {
    for (std::size_t i = 0; i < topology.buses.size(); ++i) {
      CanBusOptions host{.interface_name = topology.buses[i].interface_name, .identifiers = {}};
      CanBusOptions far_end = host;
      for (const DriveMount& drive : topology.drives) {
        if (drive.bus != i) continue;
        host.identifiers.push_back(drive.reply_id);
        host.identifiers.push_back(drive.id);  // to be confirmed, as `robot` wants it
        far_end.identifiers.push_back(drive.id);
      }
      hosts.emplace_back(host);
      far_ends.emplace_back(far_end);
    }
    for (const DriveMount& mount : topology.drives) drives.emplace_back(mount, 0.025);
  }

  void answer_until(const std::atomic<bool>& done) {
    std::array<CanEvent, CanBus::kBatch> events;
    std::vector<pollfd> waited;
    for (CanBus& bus : far_ends) waited.push_back({bus.descriptor(), POLLIN, 0});
    while (!done) {
      if (poll(waited.data(), waited.size(), 100) <= 0) continue;
      for (std::size_t bus = 0; bus < far_ends.size(); ++bus) {
        if ((waited[bus].revents & POLLIN) == 0) continue;
        const std::size_t count = far_ends[bus].receive(events);
        std::vector<CanFrame> answers;
        for (std::size_t i = 0; i < count; ++i) {
          for (EmulatedDrive& drive : drives) {
            if (const auto answer = drive.receive(events[i].frame, {}, {})) {
              answers.push_back(*answer);
            }
          }
        }
        far_ends[bus].send(answers);
      }
    }
  }

  void command_all() {
    for (std::size_t bus = 0; bus < hosts.size(); ++bus) {
      std::array<CanFrame, core::kJoints> frames;
      std::size_t count = 0;
      for (const DriveMount& drive : topology.drives) {
        if (drive.bus != bus) continue;
        ASSERT_NE(encode_setpoint(drive.family, drive.id, {.kd = 1.0}, frames[count++]),
                  EncodeStatus::not_finite);
      }
      ASSERT_EQ(hosts[bus].send({frames.data(), count}), count);
    }
  }

  int collect_answers() {
    std::array<CanEvent, CanBus::kBatch> events;
    std::vector<pollfd> waited;
    for (CanBus& bus : hosts) waited.push_back({bus.descriptor(), POLLIN, 0});
    int answers = 0;
    while (answers < core::kJoints && poll(waited.data(), waited.size(), 1000) > 0) {
      for (std::size_t bus = 0; bus < hosts.size(); ++bus) {
        if ((waited[bus].revents & POLLIN) == 0) continue;
        const std::size_t count = hosts[bus].receive(events);
        for (std::size_t i = 0; i < count; ++i) {
          answers += events[i].kind == CanEvent::Kind::received ? 1 : 0;
        }
      }
    }
    return answers;
  }
};

/// The drives answer in a thread of their own: all commands out, all answers back.
TEST(SocketCan, ExchangeWithTenDrivesIsMeasured) {
  TenDrives bench;
  sched_param priority{.sched_priority = 40};
  const bool fifo = sched_setscheduler(0, SCHED_FIFO, &priority) == 0;
  std::atomic<bool> done{false};
  std::thread motors([&] { bench.answer_until(done); });
  constexpr int kRounds = 2000;
  std::vector<double> times_us;
  int lost = 0;
  for (int round = 0; round < kRounds; ++round) {
    const double begin = now_us();
    bench.command_all();
    lost += core::kJoints - bench.collect_answers();
    times_us.push_back(now_us() - begin);
  }
  done = true;
  motors.join();
  std::sort(times_us.begin(), times_us.end());
  std::printf("exchange with ten drives%s: p50 %.0f us, p99 %.0f us, max %.0f us of %d\n",
              fifo ? " under SCHED_FIFO" : "", times_us[kRounds / 2], times_us[kRounds * 99 / 100],
              times_us.back(), kRounds);
  EXPECT_EQ(lost, 0);
}

}  // namespace
}  // namespace hopscotch::hardware
