#include "client/ui/ClientControls.h"

#include <algorithm>

#include "client/terminal/KeyTable.h"
#include "shared/net/base/Limits.h"
#include "shared/values/Canvas.h"

namespace naiad {

using namespace df::Keyboard;

namespace {

bool isControl(const KeyEvent& event, Key key) {
  return event.key == key && (event.modifiers & kControl) != 0 && (event.modifiers & (kAlt | kSuper)) == 0;
}

/// True for keys that only modify others; terminals with the kitty protocol report them, too.
bool isModifierKey(Key key) {
  return key == LEFTSHIFT || key == RIGHTSHIFT || key == LEFTCONTROL || key == RIGHTCONTROL ||
         key == LEFTALT || key == RIGHTALT;
}

/// Returns the lines that a key scrolls down; 0 if it does not scroll. `page`: number of lines of a page.
int linesDown(Key key, int page) {
  if (key == UPARROW || key == DOWNARROW) return key == UPARROW ? -1 : 1;
  if (key == PAGEUP || key == PAGEDOWN) return key == PAGEUP ? -page : page;
  return 0;
}

}  // namespace

ClientControls::Result ClientControls::handleKey(const KeyEvent& event) {
  // The game ignores releases of keys that were not pressed in it, so it may get all releases.
  if (event.action == KeyEvent::Action::kRelease) return Result::kGame;
  if (isControl(event, C)) return Result::kLeave;
  if (isControl(event, Z)) return Result::kSuspend;
  if (m_prefixed) return isModifierKey(event.key) ? Result::kHandled : handleCommand(event);
  const Key menu_key = keyOfCharacter(static_cast<unsigned char>(m_menu_letter)).key;
  const bool is_menu = isControl(event, menu_key) || isControl(event, RIGHTBRACKET);
  if (is_menu && event.action == KeyEvent::Action::kPress) {
    m_prefixed = true;
    return Result::kHandled;
  }
  if (m_chat_open) return handleChatKey(event);
  if (m_panel != Panel::kNone && event.key == ESCAPE) {
    m_panel = Panel::kNone;
    return Result::kHandled;
  }
  if (m_panel == Panel::kRooms) return handleRoomKey(event.key);
  if (m_panel != Panel::kNone && handleScrollKey(event.key)) return Result::kHandled;
  return Result::kGame;
}

// While there is nothing to scroll, these keys belong to the game.
bool ClientControls::handleScrollKey(Key key) {
  const int step = linesDown(key, std::max(m_shown.page - 1, 1));
  if (m_shown.max_scroll <= 0 || (step == 0 && key != HOME && key != END)) return false;
  const int to = std::min(m_scroll, m_shown.max_scroll) + step;
  m_scroll = key == HOME ? 0 : key == END ? m_shown.max_scroll : std::clamp(to, 0, m_shown.max_scroll);
  return true;
}

// Keys that do not move the choice or enter a room belong to the game.
ClientControls::Result ClientControls::handleRoomKey(Key key) {
  const int last = std::max(m_shown.rooms - 1, 0);
  m_room_choice = std::clamp(m_room_choice, 0, last);
  if (key == RETURN) {
    m_panel = Panel::kNone;
    return m_shown.rooms > 0 ? Result::kEnterRoom : Result::kHandled;
  }
  const int step = linesDown(key, 0);
  m_room_choice = std::clamp(m_room_choice + step, 0, last);
  return step != 0 ? Result::kHandled : Result::kGame;
}

void ClientControls::append(char32_t ch) {
  m_omitted = m_omitted || !df::isDrawable(ch);
  if (df::isDrawable(ch) && m_text.size() < kMaxChatLength) m_text.push_back(ch);
}

bool ClientControls::insertPasted(const std::u32string& text) {
  if (!m_chat_open) return false;
  for (const char32_t ch : text) append(ch);
  return true;
}

void ClientControls::setChatText(std::string_view text) {
  if (!m_chat_open) return;
  m_text.clear();
  m_omitted = false;
  insertPasted(df::decodeUtf8(std::string(text)));
}

ClientControls::Result ClientControls::handleCommand(const KeyEvent& event) {
  // A held Ctrl-G repeats; the repeats are not a command.
  if (event.action == KeyEvent::Action::kRepeat) return Result::kHandled;
  m_prefixed = false;
  if (event.ch == U'?' || event.key == H) return toggle(Panel::kHelp);
  if (event.key == P) return toggle(Panel::kPlayers);
  if (event.key == R) return toggle(Panel::kRooms);
  if (event.key == Q) return Result::kLeave;
  if (event.key == C || event.key == T) {
    if (m_chat_open) return Result::kHandled;
    m_chat_open = true;
    m_omitted = false;
    m_text.clear();
    return Result::kOpened;
  }
  if (event.key == S) {
    m_status = m_shown.status ? StatusMode::kNever : StatusMode::kAlways;
  } else {
    m_panel = Panel::kNone;
  }
  return Result::kHandled;
}

ClientControls::Result ClientControls::toggle(Panel panel) {
  m_panel = m_panel == panel ? Panel::kNone : panel;
  m_scroll = 0;
  return Result::kHandled;
}

bool ClientControls::handleHistoryKey(Key key) {
  const int step = linesDown(key, std::max(m_shown.chat_page - 1, 1));
  if (step == 0) return false;
  const int to = std::min(m_chat_scroll, m_shown.max_chat_scroll) - step;
  m_chat_scroll = std::clamp(to, 0, m_shown.max_chat_scroll);
  return true;
}

ClientControls::Result ClientControls::handleChatKey(const KeyEvent& event) {
  if (handleHistoryKey(event.key)) return Result::kHandled;
  if (event.key == ESCAPE || event.key == RETURN) {
    m_chat_open = false;
    m_chat_scroll = 0;
    return event.key == RETURN && !m_text.empty() ? Result::kSendChat : Result::kClosed;
  }
  if (event.key == BACKSPACE) {
    if (!m_text.empty()) m_text.pop_back();
  } else if (isControl(event, U)) {
    m_text.clear();
  } else if (event.ch != 0) {
    append(event.ch);
  }
  return Result::kHandled;
}

std::string ClientControls::chatText() const {
  std::string text;
  for (const char32_t ch : m_text) df::appendUtf8(text, ch);
  return text;
}

std::string ClientControls::popChat() {
  std::string text = chatText();
  m_text.clear();
  return text;
}

}  // namespace naiad
