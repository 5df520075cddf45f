#include <gtest/gtest.h>

#include <ostream>
#include <random>

#include "client/terminal/InputDecoder.h"

namespace naiad {

void PrintTo(const KeyEvent& e, std::ostream* out) {
  *out << "key " << e.key << " ch " << static_cast<unsigned>(e.ch) << " action " << static_cast<int>(e.action)
       << " modifiers " << static_cast<int>(e.modifiers);
}
void PrintTo(const MouseEvent& e, std::ostream* out) {
  *out << "mouse " << e.x << "," << e.y << " button " << e.button << " action " << static_cast<int>(e.action);
}

namespace {

using namespace df::Keyboard;
using namespace std::chrono_literals;
using Action = KeyEvent::Action;
using Events = std::vector<TerminalEvent>;
using Time = InputDecoder::Time;

const Time kFed = Time{} + 1h;

void append(Events& all, const Events& more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// Decodes `bytes`, which arrive in two pieces, split at `at`; then lets time pass.
Events decodeSplit(const std::string& bytes, std::size_t at) {
  InputDecoder decoder;
  Events events = decoder.feed(bytes.substr(0, at), kFed);
  append(events, decoder.feed(bytes.substr(at), kFed + 5ms));
  append(events, decoder.flush(kFed + 2s));
  return events;
}

KeyEvent key(Key k, char32_t ch = 0, std::uint8_t modifiers = 0, Action action = Action::kPress) {
  return {k, ch, action, modifiers};
}
MouseEvent mouse(int x, int y, df::Mouse::Button button, MouseEvent::Action action) {
  return {x, y, button, action};
}

/// Returns a key record of Windows Terminal.
std::string record(int virtual_key, int unit, bool down = true, int held = 0) {
  return "\033[" + std::to_string(virtual_key) + ";0;" + std::to_string(unit) + (down ? ";1;" : ";0;") +
         std::to_string(held) + ";1_";
}
/// Returns text that Windows Terminal itself types: for each byte a record without a key.
std::string spelled(const std::string& bytes) {
  std::string records;
  for (const char byte : bytes) records += record(0, static_cast<unsigned char>(byte));
  return records;
}

struct Case {
  const char* name;
  std::string bytes;
  Events events;
};

const std::vector<Case>& cases() {
  using M = MouseEvent::Action;
  static const std::vector<Case> all = {
      {"lower case", "a", {key(A, U'a')}},
      {"upper case is the same key with shift", "Q", {key(Q, U'Q', kShift)}},
      {"digit", "7", {key(NUM7, U'7')}},
      {"zero", "0", {key(NUM0, U'0')}},
      {"shifted digit", "!", {key(NUM1, U'!', kShift)}},
      {"closing parenthesis", ")", {key(NUM0, U')', kShift)}},
      {"space", " ", {key(SPACE, U' ')}},
      {"plus", "+", {key(PLUS, U'+', kShift)}},
      {"question mark", "?", {key(SLASH, U'?', kShift)}},
      {"backslash", "\\", {key(BACKSLASH, U'\\')}},
      {"return", "\r", {key(RETURN)}},
      {"line feed", "\n", {key(RETURN)}},
      {"tab", "\t", {key(TAB)}},
      {"delete byte is backspace", "\x7f", {key(BACKSPACE)}},
      {"control c", "\x03", {key(C, 0, kControl)}},
      {"control z", "\x1a", {key(Z, 0, kControl)}},
      {"control bracket", "\x1d", {key(RIGHTBRACKET, 0, kControl)}},
      {"control space", std::string(1, '\0'), {key(SPACE, 0, kControl)}},
      {"lone escape", "\033", {key(ESCAPE)}},
      {"escape twice", "\033\033", {key(ESCAPE), key(ESCAPE)}},
      {"alt and a letter", "\033x", {key(X, 0, kAlt)}},
      {"xterm up", "\033[A", {key(UPARROW)}},
      {"application down", "\033OB", {key(DOWNARROW)}},
      {"right, left", "\033[C\033[D", {key(RIGHTARROW), key(LEFTARROW)}},
      {"control right", "\033[1;5C", {key(RIGHTARROW, 0, kControl)}},
      {"shift up", "\033[1;2A", {key(UPARROW, 0, kShift)}},
      {"rxvt shift up", "\033[a", {key(UPARROW, 0, kShift)}},
      {"rxvt control up", "\033Oa", {key(UPARROW, 0, kControl)}},
      {"rxvt alt up", "\033\033[A", {key(UPARROW, 0, kAlt)}},
      {"shift tab", "\033[Z", {key(TAB, 0, kShift)}},
      {"xterm home, end", "\033[H\033[F", {key(HOME), key(END)}},
      {"application home, end", "\033OH\033OF", {key(HOME), key(END)}},
      {"linux home, end", "\033[1~\033[4~", {key(HOME), key(END)}},
      {"rxvt home, end", "\033[7~\033[8~", {key(HOME), key(END)}},
      {"insert, delete", "\033[2~\033[3~", {key(INSERT), key(DELETE)}},
      {"page up, page down", "\033[5~\033[6~", {key(PAGEUP), key(PAGEDOWN)}},
      {"control delete", "\033[3;5~", {key(DELETE, 0, kControl)}},
      {"rxvt shift delete, control delete",
       "\033[3$\033[3^",
       {key(DELETE, 0, kShift), key(DELETE, 0, kControl)}},
      {"xterm F1 to F4", "\033OP\033OQ\033OR\033OS", {key(F1), key(F2), key(F3), key(F4)}},
      {"xterm control F1", "\033[1;5P", {key(F1, 0, kControl)}},
      {"rxvt F1 to F5",
       "\033[11~\033[12~\033[13~\033[14~\033[15~",
       {key(F1), key(F2), key(F3), key(F4), key(F5)}},
      {"F6 to F12",
       "\033[17~\033[18~\033[19~\033[20~\033[21~\033[23~\033[24~",
       {key(F6), key(F7), key(F8), key(F9), key(F10), key(F11), key(F12)}},
      {"linux F1 to F5",
       "\033[[A\033[[B\033[[C\033[[D\033[[E",
       {key(F1), key(F2), key(F3), key(F4), key(F5)}},
      {"keypad", "\033OM\033Ok\033Op\033Oy", {key(RETURN), key(PLUS), key(NUM0), key(NUM9)}},
      {"SGR press, release",
       "\033[<0;10;5M\033[<0;10;5m",
       {mouse(9, 4, df::Mouse::LEFT, M::kPress), mouse(9, 4, df::Mouse::LEFT, M::kRelease)}},
      {"SGR right and middle",
       "\033[<2;1;1M\033[<1;300;200M",
       {mouse(0, 0, df::Mouse::RIGHT, M::kPress), mouse(299, 199, df::Mouse::MIDDLE, M::kPress)}},
      {"SGR drag with control", "\033[<48;3;4M", {mouse(2, 3, df::Mouse::LEFT, M::kDrag)}},
      {"SGR motion", "\033[<35;3;4M", {mouse(2, 3, df::Mouse::UNDEFINED_MOUSE_BUTTON, M::kMotion)}},
      {"SGR wheel is ignored", "\033[<64;3;4M\033[<65;3;4M", {}},
      {"X10 press, release",
       "\033[M !!\033[M#!!",
       {mouse(0, 0, df::Mouse::LEFT, M::kPress), mouse(0, 0, df::Mouse::LEFT, M::kRelease)}},
      {"kitty letter", "\033[97u", {key(A, U'a')}},
      {"kitty shifted letter with text", "\033[97:65;2;65u", {key(A, U'A', kShift)}},
      {"kitty repeat", "\033[97;1:2u", {key(A, U'a', 0, Action::kRepeat)}},
      {"kitty release", "\033[97;1:3u", {key(A, 0, 0, Action::kRelease)}},
      {"kitty control c", "\033[99;5u", {key(C, 0, kControl)}},
      {"kitty escape", "\033[27u", {key(ESCAPE)}},
      {"kitty enter, tab, backspace", "\033[13u\033[9u\033[127u", {key(RETURN), key(TAB), key(BACKSPACE)}},
      {"kitty arrow release", "\033[1;1:3A", {key(UPARROW, 0, 0, Action::kRelease)}},
      {"kitty delete release", "\033[3;1:3~", {key(DELETE, 0, 0, Action::kRelease)}},
      {"kitty F5 repeat with shift", "\033[15;2:2~", {key(F5, 0, kShift, Action::kRepeat)}},
      {"kitty left shift down, up",
       "\033[57441;2u\033[57441;1:3u",
       {key(LEFTSHIFT, 0, kShift), key(LEFTSHIFT, 0, 0, Action::kRelease)}},
      {"kitty keypad 5", "\033[57404u", {key(NUM5, U'5')}},
      {"kitty Cyrillic with the US key", "\033[1092::97u", {key(A, U'ф')}},
      {"kitty reply", "\033[?31u", {KittyReply{31}}},
      {"record of a letter down, up",
       record('A', 'a') + record('A', 'a', false),
       {key(A, U'a'), key(A, 0, 0, Action::kRelease)}},
      {"record with shift", record('A', 'A', true, 0x10), {key(A, U'A', kShift)}},
      {"record of a cursor key", "\033[37;75;0;1;256;1_", {key(LEFTARROW)}},
      {"record with fields left out", "\033[65;;97;1_", {key(A, U'a')}},
      {"record of control c", record('C', 3, true, 8), {key(C, 0, kControl)}},
      {"record of Ctrl-]", record(0xDD, 0x1D, true, 8), {key(RIGHTBRACKET, 0, kControl)}},
      {"record of Ctrl-] where another key types it",
       record(0xE2, 0x1D, true, 8),
       {key(RIGHTBRACKET, 0, kControl)}},
      {"record of Return, Escape, Backspace",
       record(13, 13) + record(27, 27) + record(8, 8),
       {key(RETURN), key(ESCAPE), key(BACKSPACE)}},
      {"records of both shift keys",
       "\033[16;42;0;1;16;1_\033[16;54;0;1;16;1_",
       {key(LEFTSHIFT, 0, kShift), key(RIGHTSHIFT, 0, kShift)}},
      {"records of both controls",
       "\033[17;29;0;1;8;1_\033[17;29;0;1;260;1_",
       {key(LEFTCONTROL, 0, kControl), key(RIGHTCONTROL, 0, kControl)}},
      {"record of AltGr and a sign", record('Q', '@', true, 9), {key(Q, U'@')}},
      {"record of Alt and a letter", record('A', 'a', true, 2), {key(A, 0, kAlt)}},
      {"records of the keypad and of F12", record(0x65, '5') + record(0x7B, 0), {key(NUM5, U'5'), key(F12)}},
      {"record of a letter beyond ASCII", record(0xE7, 0xE9), {key(UNDEFINED_KEY, U'é')}},
      {"records of two halves", record(0xE7, 0xD83D) + record(0xE7, 0xDE00), {key(UNDEFINED_KEY, U'😀')}},
      {"records of a paste",
       spelled("\033[200~") + record(0x10, 0, true, 0x10) + record('H', 'H', true, 0x10) +
           record('H', 'H', false) + record(13, 13) + record(0xE7, 0x20AC) + spelled("\033[201~") +
           record('B', 'b'),
       {PasteEvent{U"H €"}, key(B, U'b')}},
      {"records of a mouse report", spelled("\033[<0;1;1M"), {mouse(0, 0, df::Mouse::LEFT, M::kPress)}},
      {"records of the kitty reply", spelled("\033[?0u"), {KittyReply{0}}},
      {"records of a record", spelled(record('A', 'a')), {}},
      {"record of what is no character", record(0, 0xDC00) + record(0, 0x7FFFFF) + record(0, 0), {}},
      {"modify other keys", "\033[27;5;99~", {key(C, 0, kControl)}},
      {"UTF-8 of two, three and four bytes",
       "é€😀",
       {key(UNDEFINED_KEY, U'é'), key(UNDEFINED_KEY, U'€'), key(UNDEFINED_KEY, U'😀')}},
      {"broken UTF-8", "\xc3(\xff", {key(NUM9, U'(', kShift)}},
      {"focus", "\033[I\033[O", {FocusLost{}}},
      {"focus in key records", spelled("\033[I\033[O"), {FocusLost{}}},
      {"focus in a paste", "\033[200~a\033[Ob\033[201~", {PasteEvent{U"ab"}}},
      {"paste", "\033[200~hello\r\033[Aworld\033[201~b", {PasteEvent{U"hello world"}, key(B, U'b')}},
      {"paste of several lines",
       "\033[200~one\r\n\ttwo\nthree \xc3\xbc\xe2\x82\xac\x01\x7f\x03\033[201~",
       {PasteEvent{U"one  two three ü€"}}},
      {"paste of nothing", "\033[200~\033[201~", {}},
      {"device attributes", "\033[?62;22c\033[>41;354;0c", {}},
      {"cursor position", "\033[12;40R", {}},
      {"mode report", "\033[?2026;2$y", {}},
      {"colour reply", "\033]11;rgb:0000/0000/0000\033\\\033]10;x\007", {}},
      {"device control string", "\033P1$r0m\033\\x", {key(X, U'x')}},
      {"unknown sequences", "\033[99~\033[1;2;3;4;5;6y\033[=5;3!p\033Oz", {}},
      {"cancelled sequence", "\033[12\030a", {key(A, U'a')}},
      {"sequence within a sequence", "\033[1;\033[B", {key(DOWNARROW)}},
      {"overlong sequence", "\033[" + std::string(500, '1') + "Ax", {key(X, U'x')}},
  };
  return all;
}

// `at` is also the end of the bytes, so that they arrive in one piece.
TEST(InputDecoder, SequencesMayBeSplitAnywhere) {
  for (const Case& c : cases()) {
    for (std::size_t at = 0; at <= c.bytes.size(); ++at)
      EXPECT_EQ(decodeSplit(c.bytes, at), c.events) << c.name << " split at " << at;
  }
}

TEST(InputDecoder, DecodesByteByByte) {
  for (const Case& c : cases()) {
    InputDecoder decoder;
    Events events;
    Time now = kFed;
    for (const char byte : c.bytes) append(events, decoder.feed(std::string(1, byte), now += 1ms));
    append(events, decoder.flush(now + 2s));
    EXPECT_EQ(events, c.events) << c.name;
  }
}

TEST(InputDecoder, EscapeIsAKeyOnlyAfter25Milliseconds) {
  for (const bool in_records : {false, true}) {
    SCOPED_TRACE(in_records ? "in key records" : "as a byte");
    InputDecoder decoder;
    EXPECT_FALSE(decoder.hasKeyRecords());
    EXPECT_TRUE(decoder.feed(in_records ? spelled("\033") : "\033", kFed).empty());
    EXPECT_EQ(decoder.hasKeyRecords(), in_records);
    EXPECT_EQ(decoder.deadline(), kFed + 25ms);
    EXPECT_TRUE(decoder.flush(kFed + 24ms).empty());
    EXPECT_EQ(decoder.flush(kFed + 25ms), Events{key(ESCAPE)});
    EXPECT_FALSE(decoder.deadline());
    EXPECT_EQ(decoder.feed(in_records ? record('A', 'a') : "a", kFed + 26ms), Events{key(A, U'a')})
        << "a separate key, not part of a sequence";
  }
}

TEST(InputDecoder, LateBytesDoNotJoinAnExpiredEscape) {
  InputDecoder decoder;
  decoder.feed("\033", kFed);
  EXPECT_EQ(decoder.feed("a", kFed + 30ms), (Events{key(ESCAPE), key(A, U'a')}));
}

TEST(InputDecoder, AbandonedSequenceIsForgotten) {
  InputDecoder decoder;
  EXPECT_TRUE(decoder.feed("\033[1;", kFed).empty());
  EXPECT_TRUE(decoder.flush(kFed + 499ms).empty());
  EXPECT_TRUE(decoder.flush(kFed + 500ms).empty());
  EXPECT_EQ(decoder.feed("a", kFed + 501ms), Events{key(A, U'a')});
}

TEST(InputDecoder, APasteIsBounded) {
  InputDecoder decoder;
  Events events = decoder.feed("\033[200~" + std::string(100'000, 'x') + "\033[201~", kFed);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(std::get<PasteEvent>(events[0]).text, std::u32string(InputDecoder::kMaxPaste, U'x'));
}

TEST(InputDecoder, PasteMayPauseAndEndsByTimeout) {
  InputDecoder decoder;
  EXPECT_TRUE(decoder.feed("\033[200~one\r", kFed).empty());
  EXPECT_TRUE(decoder.feed("two", kFed + 1900ms).empty()) << "a slow line";
  EXPECT_TRUE(decoder.flush(kFed + 3800ms).empty());
  EXPECT_EQ(decoder.flush(kFed + 3900ms), Events{PasteEvent{U"one two"}});
  EXPECT_EQ(decoder.feed("a", kFed + 3901ms), Events{key(A, U'a')});
}

TEST(InputDecoder, KeyRecordPasteWithoutEndTimesOut) {
  InputDecoder decoder;
  EXPECT_TRUE(decoder.feed(spelled("\033[200~one\r"), kFed).empty());
  EXPECT_TRUE(decoder.feed("\033[", kFed + 1990ms).empty()) << "a record begins";
  EXPECT_EQ(decoder.flush(kFed + 2000ms), Events{PasteEvent{U"one "}});
  EXPECT_EQ(decoder.feed("65;30;97;1;0;1_", kFed + 2001ms), Events{key(A, U'a')});
}

TEST(InputDecoder, RandomBytesNeitherCrashNorGrow) {
  std::mt19937 random(7);
  InputDecoder decoder;
  Time now = kFed;
  // Half of the bytes begin or end sequences, so that deep states are reached.
  const std::string frequent = "\033\033\033[[[OM<?;:0123456789uAm~_P]\\\007$";
  for (int i = 0; i < 300000; ++i) {
    const auto raw = random();
    const char byte = (raw & 1) != 0 ? frequent[(raw >> 8) % frequent.size()] : static_cast<char>(raw >> 8);
    const Events events = decoder.feed(std::string(1, byte), now);
    EXPECT_LE(events.size(), 3u);
    EXPECT_LE(decoder.pendingBytes(), 128u);
    for (const TerminalEvent& event : events) {
      if (const auto* k = std::get_if<KeyEvent>(&event)) {
        EXPECT_GE(k->key, UNDEFINED_KEY);
        EXPECT_LT(k->key, kKeyCount);
      }
    }
    now += std::chrono::microseconds(random() % 2000);
    if (random() % 1000 == 0) now += 1s;
  }
}

}  // namespace
}  // namespace naiad
