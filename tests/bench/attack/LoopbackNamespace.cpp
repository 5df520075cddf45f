#include "LoopbackNamespace.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <linux/ipv6.h>
#include <net/if.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>

namespace bench::attack {

namespace {

constexpr const char* kDevice = "lo";

bool writeText(const char* name, const std::string& text) {
  const int fd = open(name, O_WRONLY | O_CLOEXEC);
  if (fd < 0) return false;
  const bool written = write(fd, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  close(fd);
  return written;
}

// Files keep their owner: this user is the same inside.
bool mapUser(uid_t user, gid_t group) {
  const std::string user_text = std::to_string(user);
  const std::string group_text = std::to_string(group);
  return writeText("/proc/self/setgroups", "deny") &&
         writeText("/proc/self/uid_map", user_text + " " + user_text + " 1") &&
         writeText("/proc/self/gid_map", group_text + " " + group_text + " 1");
}

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
