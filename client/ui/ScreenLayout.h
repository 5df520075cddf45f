// Composes the whole terminal picture: view, frame, status line, banner, chat, panels.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "client/session/ClientSession.h"
#include "client/terminal/ScreenBuffer.h"
#include "client/ui/ClientControls.h"
#include "client/ui/ViewPlacement.h"

namespace naiad {

/// Time for which a chat line is shown. While the player types a line, older lines are shown, too.
inline constexpr std::chrono::seconds kChatShown{8};

/// Contents of the screen, as values. Texts must be safe (SafeText.h).
struct ScreenModel {
  df::Canvas view;
  df::Color background = df::BLACK;  ///< background of the whole view
  CellPosition focus;                ///< view cell that must stay visible
  bool has_view = false;             ///< false before the first snapshot: only the banner is drawn
  std::string banner;                ///< a line over everything; empty: none

  bool status_shown = true;      ///< show the status where it covers nothing of the game
  bool status_over_game = true;  ///< show the status even over the game
  std::chrono::milliseconds round_trip{0};
  std::int32_t score = 0;
  std::string server;  ///< program and address of the server
  std::string game;
  std::string note;  ///< short note about a sound; empty: none

  Panel panel = Panel::kNone;
  int scroll = 0;          ///< number of lines scrolled out at the top of the panel
  std::uint32_t self = 0;  ///< this player's id
  std::string self_name;
  df::Color self_color = df::COLOR_DEFAULT;
  std::optional<CellPosition> self_cell;  ///< view cell of the player's own object, to point at
  std::vector<PlayerLine> players;
  std::string room;               ///< the player's room; empty: the server has no rooms
  std::vector<RoomLine> rooms;    ///< list of rooms for the panel
  int room_choice = 0;            ///< index of the chosen line in `rooms`
  std::vector<std::string> help;  ///< help lines of the game
  char menu_letter = 'G';         ///< ClientControls::menuLetter()
  bool browser = false;           ///< shown by a browser page, not a terminal
  bool key_releases = false;      ///< the terminal reports key releases

  bool chat_open = false;
  std::string chat_text;
  std::vector<ChatEntry> chat;     ///< lines to show over the game, oldest first
  std::vector<ChatEntry> history;  ///< newest chat lines for the side panel, oldest first
  int chat_scroll = 0;             ///< number of chat rows below the last one shown
};

struct ScreenLayout {
  ScreenBuffer picture;
  ViewPlacement placement;  ///< position of the view, for the mouse; empty if no view is shown
  ShownControls shown;
};

/// Lays out `model` on a terminal of `columns` by `rows` cells.
ScreenLayout composeScreen(const ScreenModel& model, int columns, int rows);

}  // namespace naiad
