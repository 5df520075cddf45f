#include "client/ui/ScreenLayout.h"

#include <algorithm>
#include <cstdio>
#include <functional>

#include "client/ui/SidePanel.h"
#include "shared/net/base/SafeText.h"

namespace naiad {
namespace {

constexpr int kChatRows = 6;
constexpr std::size_t kMaxOverlayNote = 20;

int columnCount(const std::string& text) {
  return static_cast<int>(columnsOf(text));
}

void drawTooSmall(Picture& picture, bool browser) {
  const std::string size = std::to_string(picture.width()) + "x" + std::to_string(picture.height());
  std::vector<std::string> lines = {"Terminal too small", size + ", needs 20x10", "Ctrl-C leaves"};
  if (browser) lines = {"Window too small", size + ", needs 20x10", ""};
  if (picture.width() < columnCount(lines[0])) lines = {"too small", size, "<20x10"};
  int y = std::max(0, (picture.height() - 3) / 2);
  for (const std::string& line : lines) {
    picture.write(std::max(0, (picture.width() - columnCount(line)) / 2), y++, line, picture.width());
  }
}

void drawView(Picture& picture, const ScreenModel& model, const ViewPlacement& place) {
  if (place.framed) picture.frame(place.left - 1, place.top - 1, place.width + 2, place.height + 2);
  for (int y = 0; y < place.height; ++y) {
    for (int x = 0; x < place.width; ++x) {
      const df::Cell cell = model.view.at(place.view_x + x, place.view_y + y);
      picture.put(place.left + x, place.top + y, {cell.ch, cell.color, Style::kPlain, model.background});
    }
  }
}

/// "ann  42 ms   tick 1200   2 players   30 points   naiad 0.1 …   Ctrl-] help", as much as fits.
void drawStatusRow(Picture& picture, const ScreenModel& model) {
  const int y = picture.height() - 1;
  picture.fill(0, y, picture.width(), 1, Style::kReverse);
  const std::string help = model.browser ? "" : "Ctrl-] help";
  const auto count = model.players.size();
  const std::string parts[] = {
      std::to_string(model.round_trip.count()) + " ms",
      std::string("tick ") + std::to_string(model.tick),
      std::to_string(count) + (count == 1 ? " player" : " players"),
      std::to_string(model.score) + " points",
      model.game,
      model.server,
  };
  const int help_at = picture.width() - columnCount(help) - 1;
  const bool room_for_help = !help.empty() && help_at > 12;
  int end = room_for_help ? help_at - 1 : picture.width();
  if (const int note_at = end - columnCount(model.note) - 1; !model.note.empty() && note_at > 12) {
    picture.write(note_at, y, model.note, end - note_at, df::COLOR_DEFAULT, Style::kReverse);
    end = note_at - 1;
  }
  int x = 1;
  if (const int name = columnCount(model.self_name); name > 0 && x + name + 2 < end)
    x = picture.write(x, y, " " + model.self_name + " ", end - x, model.self_color, Style::kReverse) + 2;
  for (const std::string& part : parts) {
    if (part.empty()) continue;
    if (end - x < columnCount(part)) break;
    x = picture.write(x, y, part, end - x, df::COLOR_DEFAULT, Style::kReverse) + 3;
  }
  if (room_for_help) picture.write(help_at, y, help, columnCount(help), df::COLOR_DEFAULT, Style::kReverse);
}

/// Beside the view, from the top down.
void drawStatusSide(Picture& picture, const ScreenModel& model) {
  const int x = picture.width() - kSideColumns + 1;
  const int width = kSideColumns - 1;
  const auto count = model.players.size();
  picture.write(x, 0, model.self_name, width, model.self_color, Style::kBold);
  const std::string lines[] = {std::to_string(model.round_trip.count()) + " ms",
                               std::to_string(count) + (count == 1 ? " player" : " players"),
                               std::to_string(model.score) + " pts",
                               "",
                               model.browser ? "" : "Ctrl-] h",
                               model.browser ? "" : "helps",
                               "",
                               model.note};
  int y = model.self_name.empty() ? 0 : 1;
  for (const std::string& line : lines) {
    if (!line.empty()) picture.write(x, y, safeText(line, static_cast<std::size_t>(width)), width);
    ++y;
  }
}

/// Is there nothing from (x, y) on, `width` cells to the right?
bool isBlank(const Picture& picture, int x, int y, int width) {
  for (int i = x; i < x + width; ++i) {
    if (picture.at(i, y).ch != U' ') return false;
  }
  return true;
}

/// A text in a corner in which the game shows nothing. In none of them: at the lower right if it `must` be.
bool drawInCorner(Picture& picture, const std::string& text, bool must) {
  const int width = columnCount(text);
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

/// Where the game takes all of the terminal. True: the status is there.
bool drawStatusOverGame(Picture& picture, const ScreenModel& model) {
  const std::string note = safeText(model.note, kMaxOverlayNote);
  if (!model.status_over_game) {
    if (!note.empty()) drawInCorner(picture, std::string(" ").append(note).append(" "), false);
    return false;
  }
  const auto count = model.players.size();
  const std::string text = (note.empty() ? " " : " " + note + "  ") +
                           std::to_string(model.round_trip.count()) + " ms  " + std::to_string(count) +
                           (count == 1 ? " player" : " players") + (model.browser ? " " : "  Ctrl-] help ");
  return drawInCorner(picture, text, true);
}

void drawBanner(Picture& picture, const std::string& banner, int row) {
  if (banner.empty()) return;
  const std::string text = std::string(" ").append(banner).append(" ");
  const int width = std::min(columnCount(text), picture.width());
  picture.write((picture.width() - width) / 2, row, text, width, df::COLOR_DEFAULT, Style::kReverse);
}

/// The line being typed. Its end is shown where it is long.
void drawChatLine(Picture& picture, const ScreenModel& model, int y) {
  picture.fill(0, y, picture.width(), 1, Style::kReverse);
  int x = picture.write(0, y, "say: ", picture.width(), df::COLOR_DEFAULT, Style::kReverse);
  std::u32string text = df::decodeUtf8(model.chat_text);
  const int room = std::max(picture.width() - x - 1, 1);
  if (static_cast<int>(text.size()) > room) text.erase(0, text.size() - static_cast<std::size_t>(room));
  for (const char32_t ch : text) picture.put(x++, y, {ch, df::COLOR_DEFAULT, Style::kReverse});
  picture.cursor = CellPosition{x, y};
}

/// Chat lines over the game, the last one in row `bottom`. Sets how far they can be scrolled.
void drawChatOver(Picture& picture, const ScreenModel& model, int bottom, ShownControls& shown) {
  const std::vector<ChatRow> rows =
      chatRows(model.chat, picture.width() - 1, 3 * kChatRows + model.chat_scroll);
  const int count = static_cast<int>(rows.size());
  const int room = std::min(model.chat_scroll > 0 ? std::max(bottom / 2, kChatRows) : kChatRows, bottom + 1);
  shown.max_chat_scroll = std::max(count - kChatRows, 0);
  shown.chat_page = kChatRows;
  const int end = count - std::clamp(model.chat_scroll, 0, shown.max_chat_scroll);
  for (int i = 0; i < std::min(end, room); ++i) {
    const ChatRow& row = rows[static_cast<std::size_t>(end - 1 - i)];
    const int width = std::min(columnCount(row.text) + 1, picture.width());
    picture.fill(0, bottom - i, width, 1);
    drawChatRow(picture, row, 0, bottom - i, width);
  }
}

/// A pointer at the player's own object, with their name where there is room.
void drawSelf(Picture& picture, const ScreenModel& model, const ViewPlacement& place) {
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
  const int width = std::min(columnCount(text), place.width);
  const int left = std::clamp(x - width / 2, 0, place.width - width);
  picture.write(place.left + left, label, text, width, model.self_color, Style::kReverse);
}

/// What a panel shows: lines, some of which stay when the others are scrolled.
struct PanelLines {
  std::string title;
  int width = 0;  ///< of the widest, which need not fit
  int fixed = 0;  ///< lines at the top that stay
  int count = 0;  ///< of all
  std::function<void(int line, int x, int y, int width)> draw;
  std::string keys = {};  ///< how to go on; empty: as every panel
};

/// How to go on, as much of it as fits on the lower edge.
std::string panelKeys(bool scrolls, int room) {
  std::vector<std::string> texts = {"Esc closes", "Esc"};
  if (scrolls)
    texts = {"Up, Down, PgUp, PgDn: more   Esc closes", "Up, Down: more  Esc closes", "Up, Down  Esc"};
  for (const std::string& text : texts) {
    if (columnCount(text) + 2 <= room) return " " + text + " ";
  }
  return "";
}

/// A framed box in the middle of the terminal. Sets what can be scrolled.
void drawPanel(Picture& picture, const PanelLines& lines, int scroll, ShownControls& shown) {
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
  picture.write(x + width - 2 - columnCount(keys), y + height - 1, keys, width);
}

void drawPlayers(Picture& picture, const ScreenModel& model, ShownControls& shown) {
  const std::vector<PlayerLine> sorted = byScore(model.players);
  const auto draw = [&](int line, int x, int y, int width) {
    char text[64];
    const int numbers = x + std::max(0, width - 19);
    const int room = x + width - numbers;
    if (line == 0) {
      std::snprintf(text, sizeof text, "%10s %8s", "points", "ms");
      picture.write(numbers, y, text, room);
      return;
    }
    const PlayerLine& player = sorted[static_cast<std::size_t>(line - 1)];
    const Style style = player.player == model.self ? Style::kBold : Style::kPlain;
    picture.write(x, y, player.name, width, player.color, style);
    std::snprintf(text, sizeof text, " %9d %8u", player.score, player.rtt_millis);
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

void drawRooms(Picture& picture, const ScreenModel& model, ShownControls& shown) {
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
  // The chosen line stays in sight.
  drawPanel(picture, panel, choice + 4 - picture.height(), shown);
}

void drawHelp(Picture& picture, const ScreenModel& model, ShownControls& shown) {
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
  for (const std::string& line : whole) wrapInto(lines, line, static_cast<std::size_t>(room));
  for (const std::string& line : lines) panel.width = std::max(panel.width, columnCount(line));
  panel.count = static_cast<int>(lines.size());
  panel.draw = [&](int line, int x, int y, int width) {
    picture.write(x, y, lines[static_cast<std::size_t>(line)], width);
  };
  drawPanel(picture, panel, model.scroll, shown);
}

}  // namespace

ScreenLayout layOut(const ScreenModel& model, int columns, int rows) {
  ScreenLayout layout{Picture(columns, rows), {}, {}};
  Picture& picture = layout.picture;
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
