// The terminal's bytes: however they are split, the events are equal and in range, little is buffered, and
// after a pause the decoder is in its initial state.
//
//   input   pieces: length + 64·pause (1) | bytes;   pause: 0 none, 1 10 ms, 2 100 ms, 3 1 s
#include <array>
#include <vector>

#include "Target.h"
#include "client/terminal/InputDecoder.h"

namespace naiad::fuzz {
namespace {

using namespace std::chrono_literals;
using Events = std::vector<TerminalEvent>;

bool isControl(char32_t ch) {
  return ch < 0x20 || (ch >= 0x7F && ch < 0xA0);
}

void requireGood(const KeyEvent& event) {
  const bool named = event.key >= 0 && event.key < df::Keyboard::kKeyCount;
  REQUIRE(named || event.key == df::Keyboard::UNDEFINED_KEY);
  REQUIRE(event.ch == 0 || !isControl(event.ch));
  REQUIRE(event.ch <= 0x10FFFF && (event.ch < 0xD800 || event.ch > 0xDFFF));
  REQUIRE(event.modifiers < 16);
}

void requireGood(const MouseEvent& event) {
  REQUIRE(event.x >= 0 && event.x <= 9999 && event.y >= 0 && event.y <= 9999);
  REQUIRE(event.button >= df::Mouse::UNDEFINED_MOUSE_BUTTON && event.button <= df::Mouse::MIDDLE);
}

void requireGood(const KittyReply& answer) {
  REQUIRE(answer.flags >= 0);
}

void requireGood(const PasteEvent& event) {
  REQUIRE(!event.text.empty() && event.text.size() <= InputDecoder::kMaxPaste);
  for (const char32_t ch : event.text) REQUIRE(!isControl(ch));
}

void requireGood(const FocusLost&) {}

void append(Events& all, const Events& events) {
  for (const TerminalEvent& event : events) {
    std::visit([](const auto& e) { requireGood(e); }, event);
    all.push_back(event);
  }
}

}  // namespace

void tryInput(Script script) {
  using namespace std::chrono_literals;
  static constexpr std::array<std::chrono::milliseconds, 4> kPauses = {0ms, 10ms, 100ms, 1000ms};
  InputDecoder whole;
  InputDecoder bytewise;
  Events events;
  Events same;
  InputDecoder::Time now{1h};
  while (!script.atEnd()) {
    const std::uint8_t head = script.byte();
    const std::string bytes = script.bytes(head & 63);
    now += kPauses[head >> 6];
    append(events, whole.feed(bytes, now));
    append(same, bytewise.flush(now));
    for (const char c : bytes) append(same, bytewise.feed({&c, 1}, now));
    REQUIRE(whole.pendingBytes() <= 128);
    REQUIRE(whole.deadline() == bytewise.deadline());
  }
  REQUIRE(events == same);

  now += 1h;
  append(events, whole.flush(now));
  REQUIRE(!whole.deadline() && whole.pendingBytes() == 0);
  const auto last = whole.feed("a", now);
  REQUIRE(last == InputDecoder().feed("a", now) && last.size() == 1);
}

}  // namespace naiad::fuzz
