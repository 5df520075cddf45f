// Where a host listens, which connections it accepts, and how players find it.
#pragma once

#include <asio/io_context.hpp>
#include <asio/ip/address.hpp>
#include <asio/ip/tcp.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "host/auth/ServerIdentity.h"
#include "host/net/NetworkThread.h"
#include "host/net/PlayerPrefixes.h"
#include "host/rooms/HostContext.h"
#include "shared/net/base/PrefixRateLimiter.h"
#include "shared/net/base/TokenBucket.h"
#include "shared/net/stream/Fingerprint.h"
#include "shared/net/stream/JoinLink.h"
#include "shared/net/stream/TcpListener.h"
#include "shared/program/ClientLog.h"

namespace naiad {

/// Logs the connections that are dropped before TLS. Rate-limited, so that a flood does not fill the host's
/// queue; the listener counts all of them.
class StreamRefusalLog {
 public:
  /// `home` runs the host's thread, where `log` is written. Both must outlive this.
  StreamRefusalLog(asio::io_context& home, ClientLog& log) : m_home(home), m_log(log) {}

  /// Call on the network thread.
  void record(const asio::ip::tcp::endpoint& peer, StreamRefusal why);

 private:
  asio::io_context& m_home;
  ClientLog& m_log;
  TokenBucket m_limit;  ///< used on the network thread
};

/// Thread: the host's.
class HostEndpoint {
 public:
  /// Starts to listen; connections wait until network().start(). `context` must outlive this. Throws
  /// ListenError, or TlsError for unusable keys.
  HostEndpoint(HostContext& context, TcpListener::OnChannel on_channel);

  NetworkThread& network() { return m_network; }
  const NetworkThread& network() const { return m_network; }
  /// The number of players of each address prefix.
  PlayerPrefixes& prefixes() { return m_prefixes; }

  std::uint16_t port() const { return m_network.port(); }
  /// The address with its port, e.g. "127.0.0.1:9876".
  std::string address() const { return m_network.address(); }
  /// The fingerprint that players compare; nullopt without encryption.
  std::optional<Fingerprint> fingerprint() const;
  /// Returns the dfclient arguments to join from this machine: "127.0.0.1:9876 --fingerprint …".
  std::string joinArguments() const;
  /// Returns the link for players on this machine or, if `elsewhere`, on any machine. For the latter,
  /// HostOptions::link_host is needed. Nullopt without it, or without encryption.
  std::optional<JoinLink> joinLink(bool elsewhere) const;
  /// Returns the command with which players join, from elsewhere if the link for them is known.
  std::string joinCommand() const;

  /// Uses this key and certificate for new connections.
  void setIdentity(ServerIdentity identity);
  /// Drops connections for which `is_banned`, called on the network thread, is true. Call before start().
  void setBanCheck(std::function<bool(const asio::ip::address& address)> is_banned) {
    m_is_banned = std::move(is_banned);
  }

 private:
  TlsListenerOptions listening();
  ProxyListenerOptions visitors() const;
  bool listensOnAll() const;

  HostContext& m_context;
  std::optional<ServerIdentity> m_identity;  ///< nullopt without encryption
  PlayerPrefixes m_prefixes;
  PrefixRateLimiter m_handshakes;  ///< used on the network thread
  StreamRefusalLog m_refusals;
  std::function<bool(const asio::ip::address&)> m_is_banned;  ///< null: no bans
  NetworkThread m_network;
};

}  // namespace naiad
