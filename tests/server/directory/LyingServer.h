// A server with its own key that answers each hello with a refusal of the test's choice.
#pragma once

#include <asio/io_context.hpp>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "host/auth/ServerIdentity.h"
#include "naiad.pb.h"
#include "shared/net/stream/Fingerprint.h"
#include "shared/net/stream/TcpListener.h"

namespace naiad::test {

/// Uses the event loop of the test.
class LyingServer {
 public:
  LyingServer(asio::io_context& context, const std::filesystem::path& identity,
              const std::string& address = "127.0.0.1")
      : m_identity(ServerIdentity::loadOrMake(identity, std::chrono::system_clock::now())),
        m_listener(context, address, 0,
                   [this](std::unique_ptr<ReliableChannel> channel) { meet(std::move(channel)); }, {},
                   {.context = m_identity.tls()}) {}

  void answer(wire::Refused_Reason reason, const std::string& sentence, const std::string& redirect,
              const std::string& room = "") {
    m_answer.mutable_refused()->set_reason(reason);
    m_answer.mutable_refused()->set_message(sentence);
    m_answer.mutable_refused()->set_redirect(redirect);
    m_answer.mutable_refused()->set_redirect_room(room);
  }
  /// Redirects players to this port of 127.0.0.1, and claims that the server there has this key.
  void sendTo(std::uint16_t port, const Fingerprint& key, const std::string& room = "") {
    answer(wire::Refused::REDIRECT, "Go on.", linkTo("127.0.0.1", port, key), room);
  }
  static std::string linkTo(const std::string& host, std::uint16_t port, const Fingerprint& key) {
    return "naiad://" + host + ":" + std::to_string(port) + "#" + ShortKey::of(key).text();
  }

  std::uint16_t port() const { return m_listener.port(); }
  const Fingerprint& key() const { return m_identity.fingerprint(); }
  std::size_t hellos() const { return m_hellos.size(); }
  const wire::Hello& hello() const { return m_hellos.back(); }

 private:
  void meet(std::unique_ptr<ReliableChannel> channel) {
    ReliableChannel& one = *channel;
    m_channels.push_back(std::move(channel));
    one.start({[this, &one](std::string_view frame) {
                 wire::ClientMessage message;
                 if (!message.ParseFromArray(frame.data(), static_cast<int>(frame.size()))) return;
                 m_hellos.push_back(message.hello());
                 one.send(m_answer.SerializeAsString());
                 one.close();
               },
               [](CloseReason) {}});
  }

  ServerIdentity m_identity;
  wire::ServerMessage m_answer;
  std::vector<wire::Hello> m_hellos;
  std::vector<std::unique_ptr<ReliableChannel>> m_channels;
  TcpListener m_listener;
};

}  // namespace naiad::test
