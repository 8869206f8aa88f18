#pragma once

#include <sched.h>

#include <cstdlib>

namespace hopscotch::apps {

/// Puts this process and its children on a network of their own with a multicast route, so that
/// tests that run at the same time do not hear each other. Where that needs rights that are
/// missing, the machine's network has to do.
inline void use_own_network() {
  if (unshare(CLONE_NEWNET) != 0 && unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) return;
  // NOLINTNEXTLINE(cert-env33-c,concurrency-mt-unsafe): fixed text, before any thread
  static_cast<void>(
      std::system("ip link set lo up multicast on && ip route add 224.0.0.0/4 dev lo"));
}

}  // namespace hopscotch::apps
