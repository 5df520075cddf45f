// Players, chat and help beside the game, on terminals that have the room.
#pragma once

#include "client/terminal/Picture.h"
#include "client/ui/ScreenLayout.h"

namespace naiad {

/// Columns of the panel beside the view; 0: there is no room for one. A page of a browser has none.
int sidePanelColumns(int columns, int rows, const ScreenModel& model);

/// Draw it into columns `x` to the right edge, rows 0 to `rows` - 1. `max_scroll`: lines of the chat's
/// history above those shown, at most.
void drawSidePanel(Picture& picture, const ScreenModel& model, int x, int rows, int& max_scroll);

/// A row of a chat entry.
struct ChatRow {
  const ChatEntry* p_entry = nullptr;
  std::string text;
  bool first = false;  ///< of its entry: the speaker stands before it
};
/// The last `count` rows and perhaps some before them, in `width` columns; all if there are fewer.
std::vector<ChatRow> chatRows(const std::vector<ChatEntry>& chat, int width, int count);

/// Draw one at (x, y).
void drawChatRow(Picture& picture, const ChatRow& row, int x, int y, int width);

/// Break a line at blanks so that each part has `width` columns at most; parts after the first are indented
/// as the explanation in a line like "Ctrl-] h   this help".
void wrapInto(std::vector<std::string>& out, const std::string& text, std::size_t width);

/// Best first.
std::vector<PlayerLine> byScore(std::vector<PlayerLine> players);

}  // namespace naiad
