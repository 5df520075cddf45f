// Separates the client's own keys from the game's, and holds the state that they change.
//
// A prefix (Ctrl-G or Ctrl-]) starts the client's commands, so that the game gets every other key but Ctrl-C
// and Ctrl-Z. But while a chat line is open, keys write text, and while a panel is open, some keys control
// it.
#pragma once

#include <string>
#include <string_view>

#include "client/terminal/InputDecoder.h"

namespace naiad {

/// Panels that the player can open over the game.
enum class Panel : unsigned char { kNone, kPlayers, kHelp, kRooms };

/// Mode of the status line. kAuto shows it if it covers nothing of the game, otherwise only for a moment.
enum class StatusMode : unsigned char { kAuto, kAlways, kNever };

/// Lines of the help panel about the client itself. They name the menu key as Ctrl-G, whichever it is.
inline constexpr const char* kClientKeyHelp[] = {
    "Ctrl-G t   say something to all players (or Ctrl-G c)",
    "Up, PgUp   in the open chat line: scroll the chat back",
    "Ctrl-G p   list of players",
    "Ctrl-G r   list of rooms, if the server has any; Return enters one",
    "Ctrl-G h   this help (or Ctrl-G ?)",
    "Ctrl-G s   status line on or off",
    "Ctrl-G q   leave the game (or Ctrl-C)",
    "Ctrl-]     like Ctrl-G",
    "Ctrl-Z     suspend; fg resumes",
    "Esc        close the help or the list",
};

/// Like kClientKeyHelp, in a browser, whose page also has buttons for the commands.
inline constexpr const char* kBrowserKeyHelp[] = {
    "Ctrl-G t   say something to all players",
    "Ctrl-G p   list of players",
    "Ctrl-G r   list of rooms, if the server has any; Enter enters one",
    "Ctrl-G h   this help",
    "Ctrl-G s   status line on or off",
    "Ctrl-G q   leave the game",
    "Ctrl-]     like Ctrl-G",
    "Esc        close the help or the list",
};

/// Last line of the help in a terminal: whether it reports key releases (docs/terminals.md).
inline constexpr const char* kKeyReleasesHelp = "Held keys  exact: this terminal reports key releases";
inline constexpr const char* kGuessedReleasesHelp =
    "Held keys  guessed: this terminal reports no key releases";

/// State of the controls in the last picture.
struct ShownControls {
  bool status = true;       ///< a status line was shown
  int max_scroll = 0;       ///< number of lines of the open panel that did not fit
  int page = 1;             ///< number of the open panel's lines shown at a time
  int max_chat_scroll = 0;  ///< maximum of chatScroll()
  int chat_page = 1;        ///< number of chat rows shown at a time
  int rooms = 0;            ///< length of the open list of rooms
};

class ClientControls {
 public:
  /// Action that the program must take for a key. Panels and the chat line have already changed.
  enum class Result {
    kGame,       ///< pass the key to the game
    kHandled,    ///< do nothing, but the picture may have changed
    kOpened,     ///< a chat line was opened: release the game's keys, turn off the terminal's key releases
    kClosed,     ///< the chat line was closed with Esc or without text
    kSendChat,   ///< the chat line was closed with Return: send popChat()
    kEnterRoom,  ///< the list of rooms was closed with Return: enter room roomChoice()
    kLeave,
    kSuspend,
  };

  /// Sets the letter, 'A' to 'Z', that starts commands together with Control; Ctrl-] does so, too.
  void setMenuLetter(char letter) { m_menu_letter = letter; }
  char menuLetter() const { return m_menu_letter; }
  Result handleKey(const KeyEvent& event);
  /// Inserts pasted text into an open chat line, up to its limit, without sending it. False if none is open.
  bool insertPasted(const std::u32string& text);
  /// Sets an open chat line to the contents of the page's text field.
  void setChatText(std::string_view text);
  /// Call when a picture was drawn.
  void onShown(const ShownControls& shown) { m_shown = shown; }

  Panel panel() const { return m_panel; }
  /// Number of lines scrolled out at the top of the panel.
  int scroll() const { return m_scroll; }
  /// Index of the chosen line in the list of rooms, from 0.
  int roomChoice() const { return m_room_choice; }
  /// Number of rows scrolled out at the bottom of the chat.
  int chatScroll() const { return m_chat_scroll; }
  StatusMode status() const { return m_status; }
  bool isChatOpen() const { return m_chat_open; }
  /// True if characters that cannot be drawn were left out of the open chat line.
  bool hasOmittedText() const { return m_chat_open && m_omitted; }
  /// True if the menu key was typed, but not yet a command.
  bool prefixed() const { return m_prefixed; }
  /// Returns the text typed so far, in UTF-8.
  std::string chatText() const;
  /// Returns the finished chat line and empties it.
  std::string popChat();

 private:
  void append(char32_t ch);
  Result handleChatKey(const KeyEvent& event);
  Result handleCommand(const KeyEvent& event);
  bool handleScrollKey(df::Keyboard::Key key);
  Result handleRoomKey(df::Keyboard::Key key);
  bool handleHistoryKey(df::Keyboard::Key key);
  Result toggle(Panel panel);

  Panel m_panel = Panel::kNone;
  int m_scroll = 0;
  int m_chat_scroll = 0;
  int m_room_choice = 0;
  StatusMode m_status = StatusMode::kAuto;
  ShownControls m_shown;
  char m_menu_letter = 'G';
  bool m_prefixed = false;
  bool m_chat_open = false;
  bool m_omitted = false;
  std::u32string m_text;
};

}  // namespace naiad
