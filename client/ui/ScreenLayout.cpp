#include "client/ui/ScreenLayout.h"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <utility>

#include "shared/net/base/SafeText.h"
#include "shared/values/Canvas.h"

namespace naiad {
namespace {

// The side panel: players, chat and help next to the game, on terminals with enough space.

// Limits of the side panel's width: fewer columns are too narrow for the texts, more do not help.
constexpr int kMinPanelColumns = 26;
constexpr int kMaxPanelColumns = 44;
constexpr int kMinPanelRows = 20;

int columnsIn(const std::string& text) {
  return static_cast<int>(columnsOf(text));
}

std::string asUtf8(const std::u32string& text) {
  std::string utf8;
  for (const char32_t ch : text) df::appendUtf8(utf8, ch);
  return utf8;
}

/// Returns `text` with the player's menu key for each "Ctrl-G".
std::string withMenuKey(const ScreenModel& model, std::string text) {
  static constexpr std::string_view kKey = "Ctrl-G";
  for (std::size_t at = 0; (at = text.find(kKey, at)) != std::string::npos; at += kKey.size())
    text[at + kKey.size() - 1] = model.menu_letter;
  return text;
}

/// Returns the column at which the explanation in a line like "Ctrl-G h   this help" begins; 2 without an
/// explanation, or if it begins in the right half of `width` columns.
std::size_t indentOf(const std::u32string& line, std::size_t width) {
  const std::size_t gap = line.find(U"  ");
  const std::size_t text = gap != std::u32string::npos ? line.find_first_not_of(U' ', gap) : gap;
  return text != std::u32string::npos && text <= width / 2 ? text : 2;
}

/// Returns "1 player", "2 players"; empty for 0.
std::string counted(std::int64_t count, const std::string& noun) {
  if (count == 0) return "";
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

/// True if a player has a score other than 0: many games count no points.
bool hasScores(const ScreenModel& model) {
  return model.score != 0 || std::any_of(model.players.begin(), model.players.end(),
                                         [](const PlayerLine& player) { return player.score != 0; });
}

/// Returns the player's own score, such as "1 point"; empty without scores.
std::string scoreText(const ScreenModel& model, const std::string& noun) {
  if (!hasScores(model)) return "";
  return model.score == 0 ? "0 " + noun + "s" : counted(model.score, noun);
}

/// Returns the players sorted by score, best first.
std::vector<PlayerLine> byScore(std::vector<PlayerLine> players) {
  std::stable_sort(players.begin(), players.end(),
                   [](const PlayerLine& a, const PlayerLine& b) { return a.score > b.score; });
  return players;
}

/// Breaks a line at blanks into parts of at most `width` columns. Parts after the first are indented like the
/// explanation in "Ctrl-G h   this help".
void wrapInto(std::vector<std::string>& out, const std::string& text, std::size_t width) {
  std::u32string rest = df::decodeUtf8(text);
  const std::size_t indent = std::min(indentOf(rest, width), width - 1);
  while (rest.size() > width) {
    const std::size_t first = rest.find_first_not_of(U' ');
    std::size_t end = rest.rfind(U' ', width);
    if (end == std::u32string::npos || end <= std::max(first, indent)) end = width;  // one long word
    out.push_back(asUtf8(rest.substr(0, end)));
    const std::size_t next = rest.find_first_not_of(U' ', end);
    rest = next == std::u32string::npos ? U"" : std::u32string(indent, U' ') + rest.substr(next);
  }
  out.push_back(asUtf8(rest));
}

/// Draws a heading and a line to the right edge.
void drawHeading(ScreenBuffer& picture, const std::string& title, int x, int y, int width) {
  int at = picture.write(x, y, title + " ", width, df::COLOR_DEFAULT, Style::kBold);
  for (; at < x + width; ++at) picture.put(at, y, {U'─'});
}

int drawPlayerRows(ScreenBuffer& picture, const ScreenModel& model, int x, int y, int width, int most) {
  const std::vector<PlayerLine> players = byScore(model.players);
  drawHeading(picture, "Players", x, y++, width);
  const int count = static_cast<int>(players.size());
  const int shown = count <= most ? count : most - 1;
  const bool scores = hasScores(model);
  for (int i = 0; i < shown; ++i, ++y) {
    const PlayerLine& player = players[static_cast<std::size_t>(i)];
    const Style style = player.player == model.self ? Style::kBold : Style::kPlain;
    const std::string points = scores ? std::to_string(player.score) : "";
    picture.write(x, y, player.name, width - columnsIn(points) - 1, player.color, style);
    picture.write(x + width - columnsIn(points), y, points, columnsIn(points), df::COLOR_DEFAULT, style);
  }
  if (shown < count) picture.write(x, y++, "and " + std::to_string(count - shown) + " more", width);
  return y + 1;
}

/// Draws the help down to row `bottom`. Returns the last row for the chat, above a blank row.
int drawHelpRows(ScreenBuffer& picture, const ScreenModel& model, int x, int bottom, int width, int most) {
  std::vector<std::string> lines;
  for (const std::string& line : model.help) wrapInto(lines, line, static_cast<std::size_t>(width));
  const std::string all = withMenuKey(model, "Ctrl-G h   all keys");
  const std::size_t room = static_cast<std::size_t>(std::max(most - 1, 0));
  if (lines.size() > room) lines.resize(room);
  lines.push_back(all);
  int y = bottom - static_cast<int>(lines.size()) + 1;
  drawHeading(picture, "Help", x, y - 1, width);
  for (const std::string& line : lines) picture.write(x, y++, line, width);
  return bottom - static_cast<int>(lines.size()) - 2;
}

struct ChatRow {
  const ChatEntry* p_entry = nullptr;
  std::string text;
  bool first = false;  ///< first row of its entry, which begins with the speaker
};

/// Returns at least the last `count` rows of the chat, in `width` columns; all rows if there are fewer.
std::vector<ChatRow> chatRows(const std::vector<ChatEntry>& chat, int width, int count) {
  std::vector<ChatRow> rows;  // newest first
  std::vector<std::string> parts;
  for (auto entry = chat.rbegin(); entry != chat.rend() && static_cast<int>(rows.size()) < count; ++entry) {
    parts.clear();
    const std::string speaker = entry->name.empty() ? "* " : entry->name + ": ";
    wrapInto(parts, speaker + entry->text, static_cast<std::size_t>(std::max(width, 4)));
    for (std::size_t i = parts.size(); i-- > 0;) rows.push_back({&*entry, std::move(parts[i]), i == 0});
  }
  std::reverse(rows.begin(), rows.end());
  return rows;
}

void drawChatRow(ScreenBuffer& picture, const ChatRow& row, int x, int y, int width) {
  picture.write(x, y, row.text, width);
  if (!row.first) return;
  const std::string& name = row.p_entry->name;
  picture.write(x, y, name.empty() ? "*" : name + ":", width, row.p_entry->color, Style::kBold);
}

/// Returns the columns of the side panel; 0 if there is not enough space, without a status, or in a browser.
int sidePanelColumns(int columns, int rows, const ScreenModel& model) {
  const int room = columns - model.view.width() - 2;  // 2: the columns of the view's frame
  if (model.browser || !model.status_shown || rows < kMinPanelRows || rows < model.view.height() ||
      room < kMinPanelColumns)
    return 0;
  return std::min(room, kMaxPanelColumns);
}

/// Draws the side panel from column `x` to the right edge, rows 0 to `rows` - 1. Sets `max_scroll` to the
/// number of chat rows that can be scrolled.
void drawSidePanel(ScreenBuffer& picture, const ScreenModel& model, int x, int rows, int& max_scroll) {
  const int left = x + 1;
  const int width = picture.width() - left - 1;
  const int top = drawPlayerRows(picture, model, left, 0, width, rows / 3);
  const int bottom = drawHelpRows(picture, model, left, rows - 1, width, rows / 3);
  drawHeading(picture, "Chat", left, top, width);
  const int room = bottom - top;
  // Get one page more than is shown, so that the chat can be scrolled further.
  const std::vector<ChatRow> lines = chatRows(model.history, width, 2 * room + model.chat_scroll);
  const int count = static_cast<int>(lines.size());
  max_scroll = std::max(count - room, 0);
  const int end = count - std::clamp(model.chat_scroll, 0, max_scroll);
  const int first = std::max(end - room, 0);
  for (int i = first; i < end; ++i) {
    drawChatRow(picture, lines[static_cast<std::size_t>(i)], left, top + 1 + i - first, width);
  }
  if (count == 0) picture.write(left, top + 1, withMenuKey(model, "Ctrl-G t   say something"), width);
}

constexpr int kChatRows = 6;
constexpr std::size_t kMaxOverlayNote = 20;

void drawTooSmall(ScreenBuffer& picture, bool browser) {
  const std::string size = std::to_string(picture.width()) + "x" + std::to_string(picture.height());
  std::vector<std::string> lines = {"Terminal too small", size + ", needs 20x10", "Ctrl-C leaves"};
  if (browser) lines = {"Window too small", size + ", needs 20x10", ""};
  if (picture.width() < columnsIn(lines[0])) lines = {"too small", size, "<20x10"};
  int y = std::max(0, (picture.height() - 3) / 2);
  for (const std::string& line : lines) {
    picture.write(std::max(0, (picture.width() - columnsIn(line)) / 2), y++, line, picture.width());
  }
}

void drawView(ScreenBuffer& picture, const ScreenModel& model, const ViewPlacement& place) {
  if (place.framed) picture.frame(place.left - 1, place.top - 1, place.width + 2, place.height + 2);
  for (int y = 0; y < place.height; ++y) {
    for (int x = 0; x < place.width; ++x) {
      const df::Cell cell = model.view.at(place.view_x + x, place.view_y + y);
      picture.put(place.left + x, place.top + y, {cell.ch, cell.color, Style::kPlain, model.background});
    }
  }
}

/// Draws "ann  42 ms   2 players   30 points   naiad 0.1 …   Ctrl-G help", as much as fits.
void drawStatusRow(ScreenBuffer& picture, const ScreenModel& model) {
  const int y = picture.height() - 1;
  picture.fill(0, y, picture.width(), 1, Style::kReverse);
  const std::string help = model.browser ? "" : withMenuKey(model, "Ctrl-G help");
  const std::string parts[] = {
      std::to_string(model.round_trip.count()) + " ms",
      counted(std::ssize(model.players), "player"),
      scoreText(model, "point"),
      model.game,
      model.server,
  };
  const int help_at = picture.width() - columnsIn(help) - 1;
  const bool room_for_help = !help.empty() && help_at > 12;
  int end = room_for_help ? help_at - 1 : picture.width();
  if (const int note_at = end - columnsIn(model.note) - 1; !model.note.empty() && note_at > 12) {
    picture.write(note_at, y, model.note, end - note_at, df::COLOR_DEFAULT, Style::kReverse);
    end = note_at - 1;
  }
  int x = 1;
  if (const int name = columnsIn(model.self_name); name > 0 && x + name + 2 < end)
    x = picture.write(x, y, " " + model.self_name + " ", end - x, model.self_color, Style::kReverse) + 2;
  for (const std::string& part : parts) {
    if (part.empty()) continue;
    if (end - x < columnsIn(part)) break;
    x = picture.write(x, y, part, end - x, df::COLOR_DEFAULT, Style::kReverse) + 3;
  }
  if (room_for_help) picture.write(help_at, y, help, columnsIn(help), df::COLOR_DEFAULT, Style::kReverse);
}

/// Draws the status in the columns at the right of the view, from the top down.
void drawStatusSide(ScreenBuffer& picture, const ScreenModel& model) {
  const int x = picture.width() - kSideColumns + 1;
  const int width = kSideColumns - 1;
  picture.write(x, 0, model.self_name, width, model.self_color, Style::kBold);
  const std::string lines[] = {std::to_string(model.round_trip.count()) + " ms",
                               counted(std::ssize(model.players), "player"),
                               scoreText(model, "pt"),
                               "",
                               model.browser ? "" : withMenuKey(model, "Ctrl-G h"),
                               model.browser ? "" : "help",
                               "",
                               model.note};
  int y = model.self_name.empty() ? 0 : 1;
  for (const std::string& line : lines) {
    if (!line.empty()) picture.write(x, y, safeText(line, static_cast<std::size_t>(width)), width);
    ++y;
  }
}

/// True if the `width` cells from (x, y) to the right are blank.
bool isBlank(const ScreenBuffer& picture, int x, int y, int width) {
  for (int i = x; i < x + width; ++i) {
    if (picture.at(i, y).ch != U' ') return false;
  }
  return true;
}

/// Draws a text in a corner where the game shows nothing. If all corners are used, draws it in the lower
/// right one if `must`. Returns true if it was drawn.
bool drawInCorner(ScreenBuffer& picture, const std::string& text, bool must) {
  const int width = columnsIn(text);
  const int right = std::max(0, picture.width() - width);
  const int bottom = picture.height() - 1;
  const CellPosition corners[] = {{right, bottom}, {right, 0}, {0, bottom}, {0, 0}};
  const auto* p_corner = std::find_if(std::begin(corners), std::end(corners), [&](CellPosition corner) {
    return isBlank(picture, corner.x, corner.y, width);
  });
  if (p_corner == std::end(corners)) p_corner = corners;
  if (!must && !isBlank(picture, p_corner->x, p_corner->y, width)) return false;
  picture.write(p_corner->x, p_corner->y, text, picture.width(), df::COLOR_DEFAULT, Style::kReverse);
  return true;
}

/// Draws the status or the note if the game takes up the whole terminal. Returns true if the status is shown.
bool drawStatusOverGame(ScreenBuffer& picture, const ScreenModel& model) {
  const std::string note = safeText(model.note, kMaxOverlayNote);
  if (!model.status_over_game) {
    if (!note.empty()) drawInCorner(picture, std::string(" ").append(note).append(" "), false);
    return false;
  }
  const std::string players = counted(std::ssize(model.players), "player");
  const std::string text =
      (note.empty() ? " " : " " + note + "  ") + std::to_string(model.round_trip.count()) + " ms" +
      (players.empty() ? "" : "  " + players) + (model.browser ? " " : withMenuKey(model, "  Ctrl-G help "));
  return drawInCorner(picture, text, true);
}

void drawBanner(ScreenBuffer& picture, const std::string& banner, int row) {
  if (banner.empty()) return;
  const std::string text = std::string(" ").append(banner).append(" ");
  const int width = std::min(columnsIn(text), picture.width());
  picture.write((picture.width() - width) / 2, row, text, width, df::COLOR_DEFAULT, Style::kReverse);
}

/// Draws the chat line that is being typed; of a long line, only the end.
void drawChatLine(ScreenBuffer& picture, const ScreenModel& model, int y) {
  picture.fill(0, y, picture.width(), 1, Style::kReverse);
  int x = picture.write(0, y, "say: ", picture.width(), df::COLOR_DEFAULT, Style::kReverse);
  std::u32string text = df::decodeUtf8(model.chat_text);
  const int room = std::max(picture.width() - x - 1, 1);
  if (static_cast<int>(text.size()) > room) text.erase(0, text.size() - static_cast<std::size_t>(room));
  for (const char32_t ch : text) picture.put(x++, y, {ch, df::COLOR_DEFAULT, Style::kReverse});
  picture.cursor = CellPosition{x, y};
}

/// Draws chat lines over the game, the last one in row `bottom`. Sets the scroll limits in `shown`.
void drawChatOver(ScreenBuffer& picture, const ScreenModel& model, int bottom, ShownControls& shown) {
  const std::vector<ChatRow> rows =
      chatRows(model.chat, picture.width() - 1, 3 * kChatRows + model.chat_scroll);
  const int count = static_cast<int>(rows.size());
  const int room = std::min(model.chat_scroll > 0 ? std::max(bottom / 2, kChatRows) : kChatRows, bottom + 1);
  shown.max_chat_scroll = std::max(count - kChatRows, 0);
  shown.chat_page = kChatRows;
  const int end = count - std::clamp(model.chat_scroll, 0, shown.max_chat_scroll);
  for (int i = 0; i < std::min(end, room); ++i) {
    const ChatRow& row = rows[static_cast<std::size_t>(end - 1 - i)];
    const int width = std::min(columnsIn(row.text) + 1, picture.width());
    picture.fill(0, bottom - i, width, 1);
    drawChatRow(picture, row, 0, bottom - i, width);
  }
}

/// Draws a pointer to the player's own object, with the player's name if there is space.
void drawSelf(ScreenBuffer& picture, const ScreenModel& model, const ViewPlacement& place) {
  if (!model.self_cell) return;
  const int x = model.self_cell->x - place.view_x;
  const int y = model.self_cell->y - place.view_y;
  if (x < 0 || y < 0 || x >= place.width || y >= place.height) return;
  const bool below = y < 3;
  const int arrow = place.top + (below ? std::min(y + 2, place.height - 1) : y - 2);
  const int label = arrow + (below ? 1 : -1);
  picture.put(place.left + x, arrow, {below ? U'▲' : U'▼', model.self_color, Style::kBold});
  if (label < place.top || label >= place.top + place.height) return;
  const std::string text = " you: " + model.self_name + " ";
  const int width = std::min(columnsIn(text), place.width);
  const int left = std::clamp(x - width / 2, 0, place.width - width);
  picture.write(place.left + left, label, text, width, model.self_color, Style::kReverse);
}

/// Contents of a panel: lines, of which some at the top do not scroll.
struct PanelLines {
  std::string title;
  int width = 0;  ///< width of the widest line; it may not fit
  int fixed = 0;  ///< number of lines at the top that do not scroll
  int count = 0;  ///< number of all lines
  std::function<void(int line, int x, int y, int width)> draw;
  std::string keys = {};  ///< keys on the lower edge; empty: panelKeys()
};

/// Returns the text about keys for the lower edge of a panel, the longest that fits into `room` columns.
std::string panelKeys(bool scrolls, int room) {
  std::vector<std::string> texts = {"Esc closes", "Esc"};
  if (scrolls)
    texts = {"Up, Down, PgUp, PgDn: more   Esc closes", "Up, Down: more  Esc closes", "Up, Down  Esc"};
  for (const std::string& text : texts) {
    if (columnsIn(text) + 2 <= room) return " " + text + " ";
  }
  return "";
}

/// Draws a framed box in the middle of the terminal. Sets the scroll limits in `shown`.
void drawPanel(ScreenBuffer& picture, const PanelLines& lines, int scroll, ShownControls& shown) {
  const int width = std::min(std::max(lines.width, 12) + 4, picture.width());
  const int height = std::min(lines.count + 2, picture.height());
  const int x = (picture.width() - width) / 2;
  const int y = (picture.height() - height) / 2;
  picture.fill(x, y, width, height);
  picture.frame(x, y, width, height);
  picture.write(x + 2, y, std::string(" ").append(lines.title).append(" "), width - 4, df::COLOR_DEFAULT,
                Style::kBold);
  const int inside = height - 2;
  shown.max_scroll = std::max(lines.count - inside, 0);
  shown.page = std::max(inside - lines.fixed, 1);
  const int first = std::clamp(scroll, 0, shown.max_scroll);
  for (int i = 0; i < inside; ++i) lines.draw(i < lines.fixed ? i : i + first, x + 2, y + 1 + i, width - 4);
  const std::string keys =
      lines.keys.empty() ? panelKeys(shown.max_scroll > 0, width - 2) : std::string(lines.keys);
  picture.write(x + width - 2 - columnsIn(keys), y + height - 1, keys, width);
}

void drawPlayers(ScreenBuffer& picture, const ScreenModel& model, ShownControls& shown) {
  const std::vector<PlayerLine> sorted = byScore(model.players);
  const bool scores = hasScores(model);
  const auto draw = [&](int line, int x, int y, int width) {
    char text[64];
    const int numbers = x + std::max(0, width - 19);
    const int room = x + width - numbers;
    if (line == 0) {
      std::snprintf(text, sizeof text, "%10s %8s", scores ? "points" : "", "ms");
      picture.write(numbers, y, text, room);
      return;
    }
    const PlayerLine& player = sorted[static_cast<std::size_t>(line - 1)];
    const Style style = player.player == model.self ? Style::kBold : Style::kPlain;
    picture.write(x, y, player.name, width, player.color, style);
    std::snprintf(text, sizeof text, " %9s %8u", scores ? std::to_string(player.score).c_str() : "",
                  player.rtt_millis);
    picture.write(numbers, y, text, room, df::COLOR_DEFAULT, style);
  };
  drawPanel(picture, {"Players", 40, 1, static_cast<int>(sorted.size()) + 1, draw}, model.scroll, shown);
}

std::string roomText(const RoomLine& room, const std::string& own) {
  char text[160];
  std::snprintf(text, sizeof text, "%c %-16s %-16s %4u/%-4u %s", room.name == own ? '*' : ' ',
                room.name.c_str(), room.game.c_str(), room.players, room.max_players,
                room.asleep ? "asleep" : "");
  return text;
}

void drawRooms(ScreenBuffer& picture, const ScreenModel& model, ShownControls& shown) {
  const int count = static_cast<int>(model.rooms.size());
  shown.rooms = count;
  const int choice = std::clamp(model.room_choice, 0, std::max(count - 1, 0));
  const auto draw = [&](int line, int x, int y, int width) {
    if (count == 0) {
      picture.write(x, y, model.room.empty() ? "This server has no rooms." : "Asking the server …", width);
    } else if (line == 0) {
      picture.write(x, y, "  room             game              players", width);
    } else {
      const std::string text = roomText(model.rooms[static_cast<std::size_t>(line - 1)], model.room);
      const Style style = line - 1 == choice ? Style::kReverse : Style::kPlain;
      picture.write(x, y, text, width, df::COLOR_DEFAULT, style);
    }
  };
  PanelLines panel{"Rooms", 52, count > 0 ? 1 : 0, count + 1, draw};
  panel.keys = count > 0 ? " Up, Down  Return enters  Esc " : "";
  // Keep the chosen line visible.
  drawPanel(picture, panel, choice + 4 - picture.height(), shown);
}

void drawHelp(ScreenBuffer& picture, const ScreenModel& model, ShownControls& shown) {
  std::vector<std::string> whole = model.help;
  if (!whole.empty()) whole.emplace_back();
  if (model.browser) {
    whole.insert(whole.end(), std::begin(kBrowserKeyHelp), std::end(kBrowserKeyHelp));
  } else {
    whole.insert(whole.end(), std::begin(kClientKeyHelp), std::end(kClientKeyHelp));
    whole.emplace_back(model.key_releases ? kKeyReleasesHelp : kGuessedReleasesHelp);
  }
  const int room = std::max(picture.width() - 4, 1);
  PanelLines panel{model.game.empty() ? "Help" : "Help: " + model.game, 0, 0, 0, {}};
  std::vector<std::string> lines;
  for (const std::string& line : whole)
    wrapInto(lines, withMenuKey(model, line), static_cast<std::size_t>(room));
  for (const std::string& line : lines) panel.width = std::max(panel.width, columnsIn(line));
  panel.count = static_cast<int>(lines.size());
  panel.draw = [&](int line, int x, int y, int width) {
    picture.write(x, y, lines[static_cast<std::size_t>(line)], width);
  };
  drawPanel(picture, panel, model.scroll, shown);
}

}  // namespace

ScreenLayout composeScreen(const ScreenModel& model, int columns, int rows) {
  ScreenLayout layout{ScreenBuffer(columns, rows), {}, {}};
  ScreenBuffer& picture = layout.picture;
  if (columns < kMinColumns || rows < kMinRows) {
    drawTooSmall(picture, model.browser);
    return layout;
  }
  if (!model.has_view) {
    drawBanner(picture, model.banner, rows / 2);
    return layout;
  }
  const int panel = sidePanelColumns(columns, rows, model);
  layout.placement = placeView(columns - panel, rows, model.view.width(), model.view.height(), model.focus,
                               model.status_shown);
  drawView(picture, model, layout.placement);
  drawSelf(picture, model, layout.placement);
  const bool has_row = layout.placement.status_row;
  const int bottom = rows - (has_row ? 2 : 1);
  if (panel > 0) {
    drawSidePanel(picture, model, columns - panel, bottom + (model.chat_open ? 0 : 1),
                  layout.shown.max_chat_scroll);
    layout.shown.chat_page = rows / 3;
  } else {
    drawChatOver(picture, model, bottom - (model.chat_open ? 1 : 0), layout.shown);
  }
  if (model.chat_open) drawChatLine(picture, model, bottom);
  layout.shown.status = has_row || layout.placement.status_side;
  if (has_row) {
    drawStatusRow(picture, model);
  } else if (layout.placement.status_side) {
    drawStatusSide(picture, model);
  } else if (model.status_shown && !model.chat_open) {
    layout.shown.status = drawStatusOverGame(picture, model);
  }
  if (model.panel == Panel::kPlayers) drawPlayers(picture, model, layout.shown);
  if (model.panel == Panel::kRooms) drawRooms(picture, model, layout.shown);
  if (model.panel == Panel::kHelp) drawHelp(picture, model, layout.shown);
  drawBanner(picture, model.banner, 0);
  return layout;
}

}  // namespace naiad
