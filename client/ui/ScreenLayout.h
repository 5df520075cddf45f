// Composes the whole terminal picture: view, frame, status line, banner, chat, panels.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "client/session/ClientSession.h"
#include "client/terminal/Picture.h"
#include "client/ui/ClientControls.h"
#include "client/ui/ViewPlacement.h"

namespace naiad {

/// Chat lines are shown this long; all recent ones while the chat line is open.
inline constexpr std::chrono::seconds kChatShown{8};

/// Everything that can be seen, as values. Texts must be safe (SafeText.h).
struct ScreenModel {
  df::Canvas view;
  df::Color background = df::BLACK;  ///< behind all characters of the view
  CellPosition focus;                ///< what must stay visible, in view cells
  bool has_view = false;             ///< false before the first snapshot: only the banner is drawn
  std::string banner;                ///< a line over everything; empty: none

  bool status_shown = true;      ///< where it covers nothing of the game
  bool status_over_game = true;  ///< and where it does
  std::chrono::milliseconds round_trip{0};
  std::uint32_t tick = 0;
  std::int32_t score = 0;
  std::string server;  ///< program and address of the server
  std::string game;
  std::string note;  ///< for a moment: what has just sounded; empty: none

  Panel panel = Panel::kNone;
  int scroll = 0;          ///< lines of the panel above its first one, if it has more than fit
  std::uint32_t self = 0;  ///< this player's id
  std::string self_name;
  df::Color self_color = df::COLOR_DEFAULT;
  std::optional<CellPosition> self_cell;  ///< where to point at the player's own object, in view cells
  std::vector<PlayerLine> players;
  std::string room;               ///< that the player is in; empty: the server has none
  std::vector<RoomLine> rooms;    ///< for their list
  int room_choice = 0;            ///< line of it that is chosen
  std::vector<std::string> help;  ///< the game's own lines
  bool browser = false;           ///< a page shows it, not a terminal
  bool key_releases = false;      ///< the terminal reports when a key goes up

  bool chat_open = false;
  std::string chat_text;
  std::vector<ChatEntry> chat;     ///< lines to show over the game, oldest first
  std::vector<ChatEntry> history;  ///< all lines, for a panel beside it
  int chat_scroll = 0;             ///< rows of the chat below the last one shown
};

struct ScreenLayout {
  Picture picture;
  ViewPlacement placement;  ///< for the mouse; empty when no view is shown
  ShownControls shown;
};

/// Lay out `model` on a terminal of `columns` by `rows` cells.
ScreenLayout layOut(const ScreenModel& model, int columns, int rows);

}  // namespace naiad
