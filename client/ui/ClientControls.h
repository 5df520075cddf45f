// The client's own keys: which belong to the client, and which to the game.
//
// One prefix (Ctrl-]) opens the client's commands, so that every other key is the game's; besides it only
// Ctrl-C and Ctrl-Z have a fixed meaning. While a chat line is open, keys write text.
#pragma once

#include <string>

#include "client/terminal/InputDecoder.h"

namespace naiad {

/// What the player has opened over the game.
enum class Panel : unsigned char { kNone, kPlayers, kHelp };

/// The lines of the help panel about the client itself.
inline constexpr const char* kClientKeyHelp[] = {
    "Ctrl-] t   say something to all players (c does the same)",
    "Ctrl-] p   list of players",
    "Ctrl-] h   this help (? does the same)",
    "Ctrl-] s   status line on or off",
    "Ctrl-] q   leave the game (Ctrl-C does the same)",
    "Ctrl-Z     suspend; fg comes back",
};

class ClientControls {
 public:
  /// What the program must do about a key; panels and chat line change here.
  enum class Result {
    kGame,     ///< the key is the game's
    kHandled,  ///< the client's own: what is drawn may have changed
    kOpened,   ///< a chat line was opened: release the game's keys, switch the terminal to text
    kClosed,   ///< the chat line was closed without text
    kSay,      ///< the chat line was closed with Return: send takeChat()
    kLeave,
    kSuspend,
  };

  /// Decide about one key event.
  Result takeKey(const KeyEvent& event);

  Panel panel() const { return m_panel; }
  bool statusShown() const { return m_status; }
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
  Result toggle(Panel panel);

  Panel m_panel = Panel::kNone;
  bool m_status = true;
  bool m_prefixed = false;
  bool m_chat_open = false;
  std::u32string m_text;
};

}  // namespace naiad
