// A network namespace for a process and its children, which contains one end of the link.
#pragma once

#include <arpa/inet.h>
#include <fcntl.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/bench/Process.h"
#include "tests/bench/UserMap.h"

namespace bench::path {

/// Thrown if the machine does not allow a link. what() is a reason without blanks, for `skipped=`.
class NotAllowed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

inline void demand(bool allowed, const char* reason) {
  if (!allowed) throw NotAllowed(reason);
}

/// Moves this process into a new user namespace (unless it is root), in which it keeps its user id and may
/// create networks. Its next child begins a new process namespace, whose processes all die with that child.
/// Throws NotAllowed.
inline void unshareProcesses() {
  const uid_t user = geteuid();
  const gid_t group = getegid();
  if (user != 0) {
    demand(unshare(CLONE_NEWUSER) == 0, "user-namespaces-not-allowed");
    demand(mapUser(user, group), "user-namespace-cannot-be-mapped");
  }
  demand(unshare(CLONE_NEWPID) == 0, "process-namespaces-not-allowed");
}

/// A network with a loopback device and a tun device, MTU 1500.
class NetworkNamespace {
 public:
  /// Creates the network and moves the calling process into it. The addresses may be loopback addresses
  /// (127/8 except 127.0.0.1), which are then reached over the link, for servers that listen only on
  /// loopback. TCP's congestion control is the machine's, because a namespace cannot choose it. Throws
  /// NotAllowed.
  NetworkNamespace(const std::string& address, const std::string& peer) {
    demand(unshare(CLONE_NEWNET) == 0, "network-namespaces-not-allowed");
    m_namespace = open("/proc/self/ns/net", O_RDONLY | O_CLOEXEC);
    demand(m_namespace >= 0, "network-namespace-cannot-be-opened");
    m_tun = open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC);
    demand(m_tun >= 0, "dev-net-tun-cannot-be-opened");
    ifreq device = request(kDevice);
    device.ifr_flags = IFF_TUN | IFF_NO_PI;
    demand(ioctl(m_tun, TUNSETIFF, &device) == 0, "tun-device-not-allowed");
    m_socket = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    bringUp("lo");
    if (address.starts_with("127.")) {
      apply(SIOCSIFNETMASK, withAddress("lo", "255.255.255.255"));  // keeps only 127.0.0.1 on loopback
      demand(writeText("/proc/sys/net/ipv4/conf/" + std::string(kDevice) + "/route_localnet", "1"),
             "loopback-addresses-cannot-be-routed");
    }
    apply(SIOCSIFADDR, withAddress(kDevice, address));
    apply(SIOCSIFDSTADDR, withAddress(kDevice, peer));
    ifreq mtu = request(kDevice);
    mtu.ifr_mtu = 1500;
    apply(SIOCSIFMTU, mtu);
    bringUp(kDevice);
  }
  ~NetworkNamespace() {
    for (const int descriptor : {m_socket, m_tun, m_namespace}) close(descriptor);
  }
  NetworkNamespace(const NetworkNamespace&) = delete;
  NetworkNamespace& operator=(const NetworkNamespace&) = delete;

  /// Runs `command` in the network, in its own session. With a `log`, that file is its stdout and stderr, and
  /// it has no stdin. Throws std::runtime_error if fork() fails. Exits with 127 if the program cannot be run.
  pid_t start(const std::vector<std::string>& command, const std::string& log) const {
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("a process cannot be forked");
    if (child == 0) become(command, log);
    return child;
  }
  /// Returns the non-blocking descriptor for IP packets.
  int tun() const { return m_tun; }

 private:
  static constexpr int kCannotRun = 127;
  static constexpr const char* kDevice = "link0";

  static ifreq request(const char* device) {
    ifreq result{};
    std::strncpy(result.ifr_name, device, IFNAMSIZ - 1);
    return result;
  }
  static ifreq withAddress(const char* name, const std::string& text) {
    ifreq device = request(name);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    demand(inet_pton(AF_INET, text.c_str(), &address.sin_addr) == 1, "address-is-not-IPv4");
    std::memcpy(&device.ifr_addr, &address, sizeof address);
    return device;
  }
  void apply(unsigned long what, ifreq device) const {
    demand(ioctl(m_socket, what, &device) == 0, "network-device-cannot-be-configured");
  }
  void bringUp(const char* name) const {
    ifreq device = request(name);
    device.ifr_flags = IFF_UP | IFF_RUNNING;
    apply(SIOCSIFFLAGS, device);
  }
  /// Moves the calling process into the network and executes the command.
  [[noreturn]] void become(const std::vector<std::string>& command, const std::string& log) const {
    if (setns(m_namespace, CLONE_NEWNET) != 0) _exit(kCannotRun);
    setsid();
    if (!log.empty()) {
      const int in = open("/dev/null", O_RDONLY | O_CLOEXEC);
      const int out = open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
      if (in < 0 || out < 0 || dup2(in, 0) < 0 || dup2(out, 1) < 0 || dup2(out, 2) < 0) _exit(kCannotRun);
    }
    std::vector<char*> argv = argvOf(command);
    execvp(argv[0], argv.data());
    std::fprintf(stderr, "naiad_link: %s cannot be run\n", argv[0]);
    _exit(kCannotRun);
  }

  int m_namespace = -1;
  int m_tun = -1;
  int m_socket = -1;  ///< a socket in this network, for ioctl()
};

}  // namespace bench::path
