// chat_resume: one player comes back on another stream again and again, and says all it may on each.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "Attack.h"
#include "Relay.h"
#include "naiad.pb.h"
#include "shared/net/base/Channel.h"
#include "shared/net/stream/TcpConnector.h"

namespace bench::attack {

class ChatResume : public Attack {
 public:
  ChatResume();
  ~ChatResume() override;

  void begin(const Target& target) override;
  void update(Time now) override;
  void end() override;
  void addFindings(Findings& findings) override;

 private:
  /// With its handshake done, so that a hello is all it takes.
  struct Stream {
    std::unique_ptr<naiad::TcpConnector> connector;
    std::unique_ptr<naiad::ReliableChannel> channel;  ///< null until it is connected
    Time since;
    bool over = false;
  };
  void prepare(Time now);
  void greet();
  void receive(Stream& stream, std::string_view frame);
  void talk(Stream& stream);

  asio::io_context* m_p_context = nullptr;
  std::unique_ptr<Relay> m_relay;
  std::deque<std::unique_ptr<Stream>> m_ready;  ///< or about to be
  std::deque<std::unique_ptr<Stream>> m_used;   ///< the last one has the session, or asked for it
  bool m_waiting = false;                       ///< for an answer to the last hello
  Time m_next_stream{};
  std::string m_token;
  std::uint32_t m_received = 0;  ///< number of the newest reliable frame
  std::uint32_t m_sent = 0;      ///< … of ours
  long long m_resumes = 0;
  long long m_refusals = 0;
  long long m_said = 0;
  long long m_streams = 0;     ///< opened, or hung up on before that
  long long m_handshakes = 0;  ///< of these, done
};

/// A line of chat of the greatest length, in characters of three bytes.
std::string longLine();

}  // namespace bench::attack
