// chat_resume: a player resumes on another stream repeatedly and sends as much chat as allowed on each.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <string_view>
#include <utility>

#include "Attack.h"
#include "Guest.h"
#include "naiad.pb.h"
#include "shared/net/base/Limits.h"

namespace bench::attack {
using namespace std::chrono_literals;

constexpr std::size_t kReady = 8;  // streams kept ready for the next resumes
constexpr auto kStale = 3s;        // discards older ones: the server waits 5 s for a hello
constexpr auto kBetween = 10ms;    // time between two new streams
constexpr auto kAfterHangUp = 100ms;
constexpr int kLines = 30;  // lines on each stream

class ChatResume : public Attack {
 public:
  void begin(const Target& target) override {
    m_p_context = &target.context;
    m_port = target.server.port();
  }
  void update(Time now) override {
    while (!m_ready.empty() && (m_ready.front()->over || now - m_ready.front()->since > kStale))
      m_ready.pop_front();
    while (m_used.size() > 2) m_used.pop_front();
    if (m_waiting && m_used.back()->over) m_waiting = false;  // disconnected without an answer
    if (m_ready.size() < kReady && now >= m_next_stream) prepare(now);
    greet();
  }
  void end() override {
    m_ready.clear();
    m_used.clear();
  }
  void addFigures(Figures& figures) override {
    figures.push_back({"resumes", static_cast<double>(m_resumes)});
    figures.push_back({"resumes_refused", static_cast<double>(m_refusals)});
    figures.push_back({"lines_sent", static_cast<double>(m_said)});
    figures.push_back({"streams", static_cast<double>(m_streams)});
  }

 private:
  /// A stream that connects and does its handshake, so that later only a hello needs to be sent.
  struct Stream {
    std::unique_ptr<Dial> dial;
    std::unique_ptr<naiad::ReliableChannel> channel;  ///< null until it is connected
    Time since;
    bool over = false;
  };

  void prepare(Time now) {
    m_next_stream = now + kBetween;
    auto stream = std::make_unique<Stream>();
    Stream& made = *stream;
    made.since = now;
    made.dial = std::make_unique<Dial>(
        *m_p_context, addressIn(4, 0), m_port,
        [this, &made](std::unique_ptr<naiad::ReliableChannel> channel) {
          made.over = channel == nullptr;
          if (made.over) m_next_stream = std::chrono::steady_clock::now() + kAfterHangUp;
          if (!channel) return;
          ++m_streams;
          made.channel = std::move(channel);
          made.channel->start({[this, &made](std::string_view frame) { receive(made, frame); },
                               [&made](naiad::CloseReason) { made.over = true; }});
        });
    m_ready.push_back(std::move(stream));
  }

  void greet() {
    if (m_waiting || m_ready.empty() || !m_ready.front()->channel) return;
    m_used.push_back(std::move(m_ready.front()));
    m_ready.pop_front();
    m_waiting = true;
    naiad::wire::ClientMessage message;
    naiad::wire::Hello& hello = *message.mutable_hello();
    hello.set_magic(naiad::kHelloMagic);
    hello.set_protocol(naiad::kProtocolVersion);
    hello.set_player_name("loud");
    hello.set_program("naiad_attack");
    hello.set_resume_token(m_token);
    hello.set_last_frame(m_received);
    m_used.back()->channel->send(message.SerializeAsString());
  }

  void receive(Stream& stream, std::string_view frame) {
    naiad::wire::ServerMessage message;
    if (!message.ParseFromArray(frame.data(), static_cast<int>(frame.size()))) return;
    m_received = std::max(m_received, message.number());
    if (message.has_refused()) {
      ++m_refusals;
      m_waiting = false;
    }
    if (!message.has_welcome()) return;
    m_waiting = false;
    m_token = message.welcome().resume_token();
    if (message.welcome().resumed()) {
      ++m_resumes;
      m_sent = message.welcome().last_frame();
    } else {
      m_received = 0;
      m_sent = 0;
    }
    talk(stream);
    greet();
  }

  void talk(Stream& stream) {
    static const std::string s_line = longLine();
    for (int i = 0; i < kLines; ++i) {
      naiad::wire::ClientMessage message;
      message.set_number(++m_sent);
      message.mutable_chat()->set_text(s_line);
      stream.channel->send(message.SerializeAsString());
    }
    m_said += kLines;
  }

  asio::io_context* m_p_context = nullptr;
  std::uint16_t m_port = 0;
  std::deque<std::unique_ptr<Stream>> m_ready;  ///< streams that are ready or connecting
  std::deque<std::unique_ptr<Stream>> m_used;   ///< the last stream has the session, or has asked for it
  bool m_waiting = false;                       ///< the last hello has not been answered
  Time m_next_stream{};
  std::string m_token;
  std::uint32_t m_received = 0;  ///< number of the newest reliable frame received
  std::uint32_t m_sent = 0;      ///< number of our newest reliable frame
  long long m_resumes = 0;
  long long m_refusals = 0;
  long long m_said = 0;
  long long m_streams = 0;  ///< streams with a complete handshake
};

}  // namespace bench::attack
