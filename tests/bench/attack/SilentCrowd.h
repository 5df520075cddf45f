// silent4, silent6: connections that never send anything.
#pragma once

#include <arpa/inet.h>
#include <linux/ipv6.h>
#include <net/if.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <asio/ip/tcp.hpp>
#include <asio/steady_timer.hpp>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "Attack.h"
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

using asio::ip::tcp;

/// A connection that never sends anything and is made again whenever it ends.
class Mute : public std::enable_shared_from_this<Mute> {
 public:
  Mute(asio::io_context& context, asio::ip::address source, tcp::endpoint server, long long& connects)
      : m_socket(context),
        m_timer(context),
        m_source(std::move(source)),
        m_server(std::move(server)),
        m_connects(connects) {}

  void connect() {
    if (m_over) return;
    asio::error_code error;
    m_socket = tcp::socket(m_socket.get_executor());
    m_socket.open(m_server.protocol(), error);
    if (!error) m_socket.bind(tcp::endpoint(m_source, 0), error);
    if (error) return again();
    m_socket.async_connect(m_server, [self = shared_from_this()](const asio::error_code& failed) {
      if (failed) return self->again();
      ++self->m_connects;
      self->listen();
    });
  }
  void end() {
    m_over = true;
    asio::error_code ignored;
    m_socket.close(ignored);
    m_timer.cancel();
  }

 private:
  void listen() {
    m_socket.async_read_some(asio::buffer(m_buffer),
                             [self = shared_from_this()](const asio::error_code& error, std::size_t) {
                               error ? self->again() : self->listen();
                             });
  }
  void again() {
    if (m_over) return;
    asio::error_code ignored;
    m_socket.close(ignored);
    m_timer.expires_after(std::chrono::milliseconds(500));
    m_timer.async_wait([self = shared_from_this()](const asio::error_code& stopped) {
      if (!stopped) self->connect();
    });
  }

  tcp::socket m_socket;
  asio::steady_timer m_timer;
  asio::ip::address m_source;
  tcp::endpoint m_server;
  long long& m_connects;
  bool m_over = false;
  std::array<char, 256> m_buffer{};
};

class SilentCrowd : public Attack {
 public:
  SilentCrowd(const std::vector<std::string>& sources, const std::string& server)
      : m_sources(sources), m_server(server) {}

  void begin(const Target& target) override {
    const tcp::endpoint server(asio::ip::make_address(m_server), target.server.port());
    for (int i = 0; i < 64; ++i) {
      for (const std::string& source : m_sources) {
        m_mutes.push_back(
            std::make_shared<Mute>(target.context, asio::ip::make_address(source), server, m_connects));
        m_mutes.back()->connect();
      }
    }
  }
  void end() override {
    for (const auto& mute : m_mutes) mute->end();
    m_mutes.clear();
  }
  void addFigures(Figures& figures) override {
    figures.push_back({"connects", static_cast<double>(m_connects)});
  }

 private:
  std::vector<std::string> m_sources;
  std::string m_server;
  std::vector<std::shared_ptr<Mute>> m_mutes;
  long long m_connects = 0;
};

}  // namespace bench::attack
