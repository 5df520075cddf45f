// A network of this process: a loopback device with additional addresses.
#pragma once

#include <arpa/inet.h>
#include <linux/ipv6.h>
#include <net/if.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>
#include <string>
#include <vector>

#include "tests/bench/UserMap.h"

namespace bench::attack {

/// Enters a new network namespace (and user namespace, so that no privilege is needed), with these IPv6
/// addresses on its loopback device. Call before starting threads. Returns "" on success, otherwise the
/// reason without blanks.
inline std::string enterLoopbackNamespace(const std::vector<std::string>& addresses) {
  const uid_t user = geteuid();
  const gid_t group = getegid();
  if (unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) return "network-namespaces-not-allowed";
  if (!mapUser(user, group)) return "user-namespace-cannot-be-mapped";
  const int device = socket(AF_INET6, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (device < 0) return "no-IPv6";
  ifreq loopback{};
  std::strcpy(loopback.ifr_name, "lo");
  loopback.ifr_flags = IFF_UP | IFF_RUNNING;
  bool done = ioctl(device, SIOCSIFFLAGS, &loopback) == 0;
  for (const std::string& address : addresses) {
    in6_ifreq request{};
    request.ifr6_prefixlen = 128;
    request.ifr6_ifindex = static_cast<int>(if_nametoindex("lo"));
    done = done && inet_pton(AF_INET6, address.c_str(), &request.ifr6_addr) == 1 &&
           ioctl(device, SIOCSIFADDR, &request) == 0;
  }
  close(device);
  return done ? "" : "IPv6-addresses-cannot-be-added";
}

}  // namespace bench::attack
