// The client's own keys: which belong to the client, and which to the game.
//
// One prefix (Ctrl-]) opens the client's commands, so that every other key is the game's; besides it only
// Ctrl-C and Ctrl-Z have a fixed meaning. While a chat line is open, keys write text.
#pragma once

#include <string>
#include <string_view>

#include "client/terminal/InputDecoder.h"

namespace naiad {

/// What the player has opened over the game.
enum class Panel : unsigned char { kNone, kPlayers, kHelp, kRooms };

/// The status line: shown where it covers nothing of the game and else for a moment; always; never.
enum class StatusMode : unsigned char { kAuto, kAlways, kNever };

/// The lines of the help panel about the client itself.
inline constexpr const char* kClientKeyHelp[] = {
    "Ctrl-] t   say something to all players (c does the same)",
    "Up, PgUp   in the open chat line: what was said before",
    "Ctrl-] p   list of players",
    "Ctrl-] r   list of rooms, where the server has some; Return goes to one",
    "Ctrl-] h   this help (? does the same)",
    "Ctrl-] s   status line on or off",
    "Ctrl-] q   leave the game (Ctrl-C does the same)",
    "Ctrl-Z     suspend; fg comes back",
    "Esc        close the help or the list",
};

/// The same in a browser, whose page has buttons for these.
inline constexpr const char* kBrowserKeyHelp[] = {
    "Ctrl-] t   say something to all players",
    "Ctrl-] p   list of players",
    "Ctrl-] r   list of rooms, where the server has some; Enter goes to one",
    "Ctrl-] h   this help",
    "Ctrl-] s   status line on or off",
    "Ctrl-] q   leave the game",
    "Esc        close the help or the list",
};

/// The last line in a terminal: how exact held keys are in this terminal (docs/terminals.md).
inline constexpr const char* kKeyReleasesHelp = "Held keys  exact: this terminal reports when a key goes up";
inline constexpr const char* kGuessedReleasesHelp =
    "Held keys  guessed: this terminal reports no key that goes up";

/// What of the controls the last picture showed.
struct ShownControls {
  bool status = true;       ///< a status line
  int max_scroll = 0;       ///< lines of the open panel that are beyond its end
  int page = 1;             ///< lines of it that are seen at a time
  int max_chat_scroll = 0;  ///< rows of the chat's history above those shown
  int chat_page = 1;        ///< rows of it that are seen at a time
  int rooms = 0;            ///< of the open list of rooms
};

class ClientControls {
 public:
  /// What the program must do about a key; panels and chat line change here.
  enum class Result {
    kGame,       ///< the key is the game's
    kHandled,    ///< the client's own: what is drawn may have changed
    kOpened,     ///< a chat line was opened: release the game's keys, switch the terminal to text
    kClosed,     ///< the chat line was closed without text
    kSay,        ///< the chat line was closed with Return: send takeChat()
    kEnterRoom,  ///< the list of rooms was closed with Return: enter that of line roomChoice()
    kLeave,
    kSuspend,
  };

  /// Decide about one key event.
  Result takeKey(const KeyEvent& event);
  /// Pasted text goes into the chat line, up to its limit, if one is open; it never sends. True if it did.
  bool insertPasted(const std::u32string& text);
  /// The chat line, if it is open, is what a text field of the page around it holds.
  void setChatText(std::string_view text);
  /// A picture was drawn.
  void noteShown(const ShownControls& shown) { m_shown = shown; }

  Panel panel() const { return m_panel; }
  /// Lines of the panel that are scrolled out at its top.
  int scroll() const { return m_scroll; }
  /// The line of the list of rooms that is chosen, from 0.
  int roomChoice() const { return m_room_choice; }
  /// Rows of the chat that are scrolled out at its bottom.
  int chatScroll() const { return m_chat_scroll; }
  StatusMode status() const { return m_status; }
  bool chatOpen() const { return m_chat_open; }
  /// Ctrl-] was typed, its command not yet.
  bool prefixed() const { return m_prefixed; }
  /// The text typed so far, UTF-8.
  std::string chatText() const;
  /// The finished line; empties it.
  std::string takeChat();

 private:
  Result takeChatKey(const KeyEvent& event);
  Result takeCommand(const KeyEvent& event);
  bool takeScrollKey(df::Keyboard::Key key);
  Result takeRoomKey(df::Keyboard::Key key);
  bool takeHistoryKey(df::Keyboard::Key key);
  Result toggle(Panel panel);

  Panel m_panel = Panel::kNone;
  int m_scroll = 0;
  int m_chat_scroll = 0;
  int m_room_choice = 0;
  StatusMode m_status = StatusMode::kAuto;
  ShownControls m_shown;
  bool m_prefixed = false;
  bool m_chat_open = false;
  std::u32string m_text;
};

}  // namespace naiad
