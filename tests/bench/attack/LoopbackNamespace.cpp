#include "LoopbackNamespace.h"

#include <arpa/inet.h>
#include <linux/ipv6.h>
#include <net/if.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>

#include "tests/bench/UserMap.h"

namespace bench::attack {
namespace {

constexpr const char* kDevice = "lo";

bool bringUp(int socket) {
  ifreq request{};
  std::strncpy(request.ifr_name, kDevice, IFNAMSIZ - 1);
  request.ifr_flags = IFF_UP | IFF_RUNNING;
  return ioctl(socket, SIOCSIFFLAGS, &request) == 0;
}

bool addAddress(int socket, const std::string& text) {
  in6_ifreq request{};
  request.ifr6_prefixlen = 128;
  request.ifr6_ifindex = static_cast<int>(if_nametoindex(kDevice));
  return inet_pton(AF_INET6, text.c_str(), &request.ifr6_addr) == 1 &&
         ioctl(socket, SIOCSIFADDR, &request) == 0;
}

}  // namespace

std::optional<std::string> enterLoopbackNamespace(const std::vector<std::string>& addresses) {
  const uid_t user = geteuid();
  const gid_t group = getegid();
  if (unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) return "network-namespaces-not-allowed";
  if (!mapUser(user, group)) return "user-namespace-cannot-be-mapped";
  const int device = socket(AF_INET6, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (device < 0) return "no-IPv6";
  bool done = bringUp(device);
  for (const std::string& address : addresses) done = done && addAddress(device, address);
  close(device);
  if (!done) return "IPv6-addresses-cannot-be-added";
  return std::nullopt;
}

}  // namespace bench::attack
