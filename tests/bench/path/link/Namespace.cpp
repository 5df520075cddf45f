#include "Namespace.h"

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

#include "../Argv.h"
#include "tests/bench/UserMap.h"

namespace bench::path {
namespace {

constexpr int kCannotRun = 127;
constexpr int kMtu = 1500;
const char* const kDevice = "link0";

ifreq request(const char* device) {
  ifreq result{};
  std::strncpy(result.ifr_name, device, IFNAMSIZ - 1);
  return result;
}

ifreq withAddress(const char* name, const std::string& text) {
  ifreq device = request(name);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  if (inet_pton(AF_INET, text.c_str(), &address.sin_addr) != 1) throw NotAllowed("address-is-not-IPv4");
  std::memcpy(&device.ifr_addr, &address, sizeof address);
  return device;
}

int openTun() {
  const int fd = open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) throw NotAllowed("dev-net-tun-cannot-be-opened");
  ifreq device = request(kDevice);
  device.ifr_flags = IFF_TUN | IFF_NO_PI;
  if (ioctl(fd, TUNSETIFF, &device) == 0) return fd;
  close(fd);
  throw NotAllowed("tun-device-not-allowed");
}

void redirect(const std::string& log) {
  const int in = open("/dev/null", O_RDONLY | O_CLOEXEC);
  const int out = open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  if (in < 0 || out < 0 || dup2(in, 0) < 0 || dup2(out, 1) < 0 || dup2(out, 2) < 0) _exit(kCannotRun);
}

/// Calls ioctl() on a device through a socket of the present namespace.
class Configuration {
 public:
  Configuration() : m_socket(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {}
  ~Configuration() { close(m_socket); }
  Configuration(const Configuration&) = delete;
  Configuration& operator=(const Configuration&) = delete;

  void apply(unsigned long what, ifreq device) const {
    if (ioctl(m_socket, what, &device) != 0) throw NotAllowed("network-device-cannot-be-configured");
  }
  void keepOnlyOwnLoopbackAddress() const { apply(SIOCSIFNETMASK, withAddress("lo", "255.255.255.255")); }
  void bringUp(const char* name) const {
    ifreq device = request(name);
    device.ifr_flags = IFF_UP | IFF_RUNNING;
    apply(SIOCSIFFLAGS, device);
  }

 private:
  int m_socket;
};

}  // namespace

void unshareProcesses() {
  const uid_t user = geteuid();
  const gid_t group = getegid();
  if (user != 0) {
    if (unshare(CLONE_NEWUSER) != 0) throw NotAllowed("user-namespaces-not-allowed");
    if (!mapUser(user, group)) throw NotAllowed("user-namespace-cannot-be-mapped");
  }
  if (unshare(CLONE_NEWPID) != 0) throw NotAllowed("process-namespaces-not-allowed");
}

NetworkNamespace::NetworkNamespace(const std::string& address, const std::string& peer) {
  if (unshare(CLONE_NEWNET) != 0) throw NotAllowed("network-namespaces-not-allowed");
  m_namespace = open("/proc/self/ns/net", O_RDONLY | O_CLOEXEC);
  if (m_namespace < 0) throw NotAllowed("network-namespace-cannot-be-opened");
  m_tun = openTun();
  configure(address, peer);
}

NetworkNamespace::~NetworkNamespace() {
  close(m_tun);
  close(m_namespace);
}

void NetworkNamespace::configure(const std::string& address, const std::string& peer) const {
  const Configuration configuration;
  configuration.bringUp("lo");
  if (address.starts_with("127.")) {
    configuration.keepOnlyOwnLoopbackAddress();
    if (!writeText("/proc/sys/net/ipv4/conf/" + std::string(kDevice) + "/route_localnet", "1")) {
      throw NotAllowed("loopback-addresses-cannot-be-routed");
    }
  }
  configuration.apply(SIOCSIFADDR, withAddress(kDevice, address));
  configuration.apply(SIOCSIFDSTADDR, withAddress(kDevice, peer));
  ifreq mtu = request(kDevice);
  mtu.ifr_mtu = kMtu;
  configuration.apply(SIOCSIFMTU, mtu);
  configuration.bringUp(kDevice);
}

void NetworkNamespace::become(const std::vector<std::string>& command, const std::string& log) const {
  if (setns(m_namespace, CLONE_NEWNET) != 0) _exit(kCannotRun);
  setsid();
  if (!log.empty()) redirect(log);
  std::vector<char*> argv = argvOf(command);
  execvp(argv[0], argv.data());
  std::fprintf(stderr, "naiad_link: %s cannot be run\n", argv[0]);
  _exit(kCannotRun);
}

pid_t NetworkNamespace::start(const std::vector<std::string>& command, const std::string& log) const {
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("a process cannot be forked");
  if (child == 0) become(command, log);
  return child;
}

}  // namespace bench::path
