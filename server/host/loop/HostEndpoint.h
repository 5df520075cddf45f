// Where a host listens, whom it lets that far, and how it is found there.
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
#include "shared/net/base/PrefixAllowance.h"
#include "shared/net/base/TokenBucket.h"
#include "shared/net/stream/Fingerprint.h"
#include "shared/net/stream/JoinLink.h"
#include "shared/net/stream/TcpListener.h"
#include "shared/program/ClientLog.h"

namespace naiad {

/// Logs the connections that are hung up on before TLS.
/// A flood of them must not fill the host's queue: what is left out is counted by the listener all the same.
class StreamRefusalLog {
 public:
  /// `home` runs the host's thread, where `log` is written; both outlive this.
  StreamRefusalLog(asio::io_context& home, ClientLog& log) : m_home(home), m_log(log) {}

  /// On the network thread.
  void note(const asio::ip::tcp::endpoint& peer, StreamRefusal why);

 private:
  asio::io_context& m_home;
  ClientLog& m_log;
  TokenBucket m_allowance;  ///< of the network thread
};

/// On the host's thread.
class HostEndpoint {
 public:
  /// Listens from now on; connections wait until network().start(). `context` outlives this. Throws
  /// ListenError, or TlsError for keys that cannot be used.
  HostEndpoint(HostContext& context, TcpListener::OnChannel on_channel);

  NetworkThread& network() { return m_network; }
  const NetworkThread& network() const { return m_network; }
  /// The addresses that players come from.
  PlayerPrefixes& prefixes() { return m_prefixes; }

  std::uint16_t port() const { return m_network.port(); }
  /// "127.0.0.1:9876".
  std::string address() const { return m_network.address(); }
  /// What players compare; nothing without encryption.
  std::optional<Fingerprint> fingerprint() const;
  /// What dfclient needs on its command line to join from this machine: "127.0.0.1:9876 --fingerprint …".
  std::string joinArguments() const;
  /// The link for players of this machine, or of any machine if HostOptions::link_host is given and
  /// `elsewhere` asked for. Nothing without encryption.
  std::optional<JoinLink> joinLink(bool elsewhere) const;

  /// Connections from now on meet this key.
  void setIdentity(ServerIdentity identity);
  /// Connections that this is true for are hung up on. It is called on the network's thread. Before start().
  void setBans(std::function<bool(const asio::ip::address& address)> is_banned) {
    m_is_banned = std::move(is_banned);
  }

 private:
  TlsListening listening();
  VisitorsListening visitors() const;
  bool listensOnAll() const;

  HostContext& m_context;
  std::optional<ServerIdentity> m_identity;  ///< nothing: without encryption
  PlayerPrefixes m_prefixes;
  PrefixAllowance m_handshakes;  ///< of the network thread
  StreamRefusalLog m_refusals;
  std::function<bool(const asio::ip::address&)> m_is_banned;  ///< null: nobody is
  NetworkThread m_network;
};

}  // namespace naiad
