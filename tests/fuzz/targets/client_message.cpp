// Server side of a client's frames: parsing, checks and dispatch, on a channel without a network. Before the
// hello, a frame is only answered with a refusal; there is one hello, and its values are in range.
//
//   input   frames: length + 2^13·as a datagram + 2^14·tick before it + 2^15·after a valid hello (2)
//                   | the frame's payload
//           length 0: an event of the channel or host (1): 0 closed, 1 busy, 2 the last frame 100 times,
//           3 goodbye, 252 a second stream opens, 253 later frames come on the other stream, 254 the second
//           closes, 255 it is busy, otherwise that many half seconds pass
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "Target.h"
#include "host/net/SealedChannel.h"
#include "host/session/Session.h"
#include "naiad.pb.h"
#include "proto/ParseErrors.h"
#include "shared/net/base/Limits.h"
#include "shared/replica/Limits.h"
#include "tests/support/FakeChannel.h"

namespace naiad::fuzz {
namespace {

using namespace std::chrono_literals;
using test::FakeChannel;
using test::FakeLine;

constexpr std::uint8_t kSecond = 252, kOther = 253, kClosed = 254, kBusy = 255;
constexpr auto kSteering = static_cast<df::Keyboard::Key>(5);

/// The source of a FakeSealed's packets. Must outlive it.
struct FakeAir {
  std::function<void(std::string_view packet)> on_packet;
};

/// A datagram channel without a network.
class FakeSealed : public SealedChannel {
 public:
  explicit FakeSealed(FakeAir& air) : m_air(air) {}
  ~FakeSealed() override { m_air.on_packet = nullptr; }
  void start(std::function<void(std::string_view packet)> on_packet) override {
    m_air.on_packet = std::move(on_packet);
  }
  void send(std::string_view) override {}
  std::optional<std::size_t> payloadBudget() const override { return kMaxDatagramSnapshot; }
  std::string peerAddress() const override { return "fake:1"; }
  std::uint64_t id() const override { return 1; }
  AeadId aead() const override { return AeadId::kAes128Gcm; }
  Epoch epoch() const override { return 1; }
  bool renew(const ReliableChannel&, Epoch) override { return true; }

 private:
  FakeAir& m_air;
};

class Play {
 public:
  Play() : m_session(std::make_unique<FakeChannel>(m_line), m_counters, m_now) {
    m_session.start({[this](Session& session, const wire::Hello& hello) { greet(session, hello); },
                     [](Session&, const std::string& text) {
                       REQUIRE(!text.empty() && text.size() <= 4 * kMaxChatLength);
                     },
                     [this](Session&) { REQUIRE(++m_gone == 1); },
                     [this] { return m_now; },
                     {},
                     [](Session&) {},
                     [this](Session&, const std::string& room) {
                       REQUIRE(room.size() <= kMaxClientFrame);
                       m_moves = true;
                     }});
    // With declared controls, an input waits for the tick that it names.
    auto controls = std::make_shared<df::ControlTable>();
    controls->rows.push_back(
        {kSteering, df::KEY_PRESSED, df::ControlEffect::kStep, true, false, {df::kFixedOne, 0}, 0, 0});
    m_session.setControls(std::move(controls));
  }

  void hear(std::string_view frame) {
    if (m_on_second) return hearSecond(frame);
    if (m_line.closed || frame.empty() || frame.size() > m_line.receive_limit) return;  // never arrives
    m_last = frame;
    const Exactly bytes(m_last);
    m_line.callbacks.on_frame(bytes.view());
    // This host answers a hello at once, so the session does not wait for its answer after a frame.
    REQUIRE(m_session.state() != Session::State::kGreeting);
    REQUIRE((m_session.state() == Session::State::kEnding) == m_line.closed);
    REQUIRE(m_gone == (m_line.closed ? 1 : 0));
  }
  void hearSecond(std::string_view frame) {
    if (m_second.closed || !m_second.callbacks.on_frame) return;
    if (frame.empty() || frame.size() > m_second.receive_limit) return;
    m_last = frame;
    const Exactly bytes(m_last);
    const auto on_frame = m_second.callbacks.on_frame;  // a copy, because the callee may destroy the channel
    on_frame(bytes.view());
    REQUIRE(m_second.closed == !m_session.hasSecondStream());
    REQUIRE(m_gone == (m_line.closed ? 1 : 0));
  }
  void hearDatagram(std::string_view payload) {
    if (m_sealed.on_packet == nullptr) return;
    const Exactly bytes(payload);
    m_sealed.on_packet(bytes.view());
    REQUIRE(m_gone == (m_line.closed ? 1 : 0));
  }
  void hello() {
    if (m_session.state() != Session::State::kGreeting) return;
    wire::ClientMessage message;
    message.mutable_hello()->set_magic(kHelloMagic);
    message.mutable_hello()->set_protocol(kProtocolVersion);
    hear(message.SerializeAsString());
  }
  void meddle(std::uint8_t what) {
    if (what == 0 && !m_line.closed) {
      m_line.closed = true;
      m_line.callbacks.on_closed(CloseReason::kProtocol);
      REQUIRE(m_session.state() == Session::State::kGone && m_gone == 1);
    }
    if (what == 1) m_line.unsent ^= 1;
    if (what == 2) {
      for (int i = 0; i < 100; ++i) hear(std::string(m_last));
    }
    if (what == 3 && m_session.state() == Session::State::kPlaying) m_session.sendGoodbye("Bye.");
    if (what == kSecond) openSecond();
    if (what == kOther) m_on_second = !m_on_second;
    if (what == kClosed && m_session.hasSecondStream()) {
      const auto on_closed = m_second.callbacks.on_closed;
      on_closed(CloseReason::kPeer);
      REQUIRE(!m_session.hasSecondStream());
    }
    if (what == kBusy) m_second.unsent ^= 1;
    if (what > 3 && what < kSecond) m_now += 500ms * what;
  }
  void tick() {
    m_now += 33ms;
    m_session.checkDeadlines(m_now);
    ++m_view.tick;
    m_publisher.update(m_view);
    if (m_session.state() != Session::State::kPlaying) return;
    if (std::exchange(m_moves, false)) move();
    m_session.drainInputs(m_view.tick, [this](const Input& input) {
      REQUIRE(m_input == 0 || isNewer(input.id, m_input));
      REQUIRE(input.key < df::Keyboard::kKeyCount && input.x < kMaxViewWidth && input.y < kMaxViewHeight);
      m_input = input.id;
    });
    m_session.sendTick(m_publisher, m_player);
  }

 private:
  // Moves the player to a room whose world is equal but is sent again in another epoch.
  void move() {
    wire::Welcome welcome = m_session.welcomed();
    welcome.set_player(welcome.player() + 1);
    welcome.set_room("other");
    const auto epoch = m_session.sender().epoch();
    m_session.enterRoom(welcome);
    REQUIRE(m_session.player() == welcome.player() && m_session.sender().epoch() != epoch);
  }
  // Opens the second stream; only the first call has an effect, because the channel cannot be reset.
  void openSecond() {
    if (m_session.state() != Session::State::kPlaying || m_second.callbacks.on_frame) return;
    Session other(std::make_unique<FakeChannel>(m_second), m_counters, m_now);
    other.start({[this](Session& session, const wire::Hello&) { m_session.attachSecondStream(session); },
                 [](Session&, const std::string&) {}, [](Session&) { REQUIRE(false); },
                 [this] { return m_now; }});
    wire::ClientMessage message;
    message.mutable_hello()->set_magic(kHelloMagic);
    m_second.callbacks.on_frame(message.SerializeAsString());
    REQUIRE(other.state() == Session::State::kGone && m_session.hasSecondStream());
  }
  void greet(Session& session, const wire::Hello& hello) {
    REQUIRE(++m_hellos == 1 && hello.magic() == kHelloMagic);
    if (hello.protocol() != kProtocolVersion)
      return session.refuse(wire::Refused::VERSION, "Another version.");
    wire::Welcome welcome;
    welcome.set_player(7);
    session.welcome(welcome, std::make_unique<FakeSealed>(m_sealed));
  }

  Session::Clock::time_point m_now{1h};
  FakeLine m_line;
  FakeLine m_second;
  bool m_on_second = false;
  bool m_moves = false;
  FakeAir m_sealed;
  std::string m_last;  ///< the last frame passed to the session
  Counters m_counters;
  Session m_session;
  int m_hellos = 0;
  int m_gone = 0;
  std::uint32_t m_input = 0;
  df::WorldView m_view;
  df::PlayerFacts m_player;
  Publisher m_publisher;
};

}  // namespace

void tryInput(Script script) {
  silenceParseErrors();
  Play play;
  while (!script.atEnd()) {
    const auto head = script.number<std::uint16_t>();
    if ((head & 0x4000) != 0) play.tick();
    if ((head & 0x8000) != 0) play.hello();
    const std::size_t length = head & 0x1FFF;
    if ((head & 0x2000) != 0) {
      play.hearDatagram(script.bytes(length));
    } else if (length == 0) {
      play.meddle(script.byte());
    } else {
      play.hear(script.bytes(length));
    }
  }
}

}  // namespace naiad::fuzz
