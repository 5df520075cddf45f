#include "client/ui/ScreenLayout.h"

#include <algorithm>
#include <cstdio>

#include "shared/net/base/SafeText.h"

namespace naiad {
namespace {

constexpr std::size_t kChatRows = 6;
constexpr std::size_t kMaxOverlayNote = 20;

int columnCount(const std::string& text) {
  return static_cast<int>(columnsOf(text));
}

void drawTooSmall(Picture& picture) {
  const std::string size = std::to_string(picture.width()) + "x" + std::to_string(picture.height());
  std::vector<std::string> lines = {"Terminal too small", size + ", needs 20x10", "Ctrl-C leaves"};
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

/// "42 ms   tick 1200   2 players   30 points   naiad 0.1 …   Ctrl-] help", as much as fits.
void drawStatusRow(Picture& picture, const ScreenModel& model) {
  const int y = picture.height() - 1;
  picture.fill(0, y, picture.width(), 1, Style::kReverse);
  const std::string help = "Ctrl-] help";
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
  const bool room_for_help = help_at > 12;
  int end = room_for_help ? help_at - 1 : picture.width();
  if (const int note_at = end - columnCount(model.note) - 1; !model.note.empty() && note_at > 12) {
    picture.write(note_at, y, model.note, end - note_at, df::COLOR_DEFAULT, Style::kReverse);
    end = note_at - 1;
  }
  int x = 1;
  for (const std::string& part : parts) {
    if (part.empty()) continue;
    if (end - x < columnCount(part)) break;
    x = picture.write(x, y, part, end - x, df::COLOR_DEFAULT, Style::kReverse) + 3;
  }
  if (room_for_help) picture.write(help_at, y, help, columnCount(help), df::COLOR_DEFAULT, Style::kReverse);
}

void drawStatusOverlay(Picture& picture, const ScreenModel& model) {
  // Here it covers a piece of the game, so it stays short.
  const std::string note = safeText(model.note, kMaxOverlayNote);
  const std::string text = (note.empty() ? " " : " " + note + "  ") +
                           std::to_string(model.round_trip.count()) + "ms t" + std::to_string(model.tick) +
                           " " + std::to_string(model.players.size()) + "p ^]h ";
  const int x = std::max(0, picture.width() - columnCount(text));
  picture.write(x, picture.height() - 1, text, picture.width(), df::COLOR_DEFAULT, Style::kReverse);
}

void drawBanner(Picture& picture, const std::string& banner, int row) {
  if (banner.empty()) return;
  const std::string text = std::string(" ").append(banner).append(" ");
  const int width = std::min(columnCount(text), picture.width());
  picture.write((picture.width() - width) / 2, row, text, width, df::COLOR_DEFAULT, Style::kReverse);
}

/// The last chat lines, bottom up, and below them the line being typed.
void drawChat(Picture& picture, const ScreenModel& model, int bottom) {
  int y = bottom;
  if (model.chat_open) {
    const std::string prompt = "say: ";
    picture.fill(0, y, picture.width(), 1, Style::kReverse);
    int x = picture.write(0, y, prompt, picture.width(), df::COLOR_DEFAULT, Style::kReverse);
    // The end of a long text is shown.
    std::u32string text = df::decodeUtf8(model.chat_text);
    const int room = std::max(picture.width() - x - 1, 1);
    if (static_cast<int>(text.size()) > room) text.erase(0, text.size() - static_cast<std::size_t>(room));
    for (const char32_t ch : text) picture.put(x++, y, {ch, df::COLOR_DEFAULT, Style::kReverse});
    picture.cursor = CellPosition{x, y};
    --y;
  }
  const std::size_t count = std::min(model.chat.size(), kChatRows);
  for (std::size_t i = 0; i < count && y >= 0; ++i, --y) {
    const ChatEntry& entry = model.chat[model.chat.size() - 1 - i];
    int x = 0;
    if (entry.name.empty()) {
      x = picture.write(x, y, "* ", picture.width(), df::COLOR_DEFAULT, Style::kBold);
    } else {
      x = picture.write(x, y, entry.name, picture.width() - x, entry.color, Style::kBold);
      x = picture.write(x, y, ": ", picture.width() - x, entry.color, Style::kBold);
    }
    picture.write(x, y, entry.text + " ", picture.width() - x);
  }
}

/// A framed box in the middle of the terminal, with a title. Returns the first cell inside.
CellPosition drawBox(Picture& picture, const std::string& title, int inner_width, int inner_height) {
  const int width = std::min(inner_width + 4, picture.width());
  const int height = std::min(inner_height + 2, picture.height());
  const int x = (picture.width() - width) / 2;
  const int y = (picture.height() - height) / 2;
  picture.fill(x, y, width, height);
  picture.frame(x, y, width, height);
  picture.write(x + 2, y, std::string(" ").append(title).append(" "), width - 4, df::COLOR_DEFAULT,
                Style::kBold);
  return {x + 2, y + 1};
}

void drawPlayers(Picture& picture, const ScreenModel& model) {
  std::vector<PlayerLine> sorted = model.players;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const PlayerLine& a, const PlayerLine& b) { return a.score > b.score; });
  const int rows = std::min(static_cast<int>(sorted.size()) + 1, picture.height() - 2);
  const int inner = std::min(40, picture.width() - 4);
  const CellPosition at = drawBox(picture, "Players", inner, rows);
  char line[64];
  std::snprintf(line, sizeof line, "%10s %8s", "points", "ms");
  const int numbers = at.x + std::max(0, inner - 19);
  picture.write(numbers, at.y, line, at.x + inner - numbers);
  for (int i = 0; i + 1 < rows; ++i) {
    const PlayerLine& player = sorted[static_cast<std::size_t>(i)];
    const Style style = player.player == model.self ? Style::kBold : Style::kPlain;
    picture.write(at.x, at.y + 1 + i, player.name, inner, player.color, style);
    std::snprintf(line, sizeof line, " %9d %8u", player.score, player.rtt_millis);
    picture.write(numbers, at.y + 1 + i, line, at.x + inner - numbers, df::COLOR_DEFAULT, style);
  }
}

void drawHelp(Picture& picture, const ScreenModel& model) {
  std::vector<std::string> lines(std::begin(kClientKeyHelp), std::end(kClientKeyHelp));
  if (!model.help.empty()) {
    lines.insert(lines.begin(), "");
    lines.insert(lines.begin(), model.help.begin(), model.help.end());
  }
  int inner = 0;
  for (const std::string& line : lines) inner = std::max(inner, columnCount(line));
  inner = std::min(inner, picture.width() - 4);
  const int rows = std::min(static_cast<int>(lines.size()), picture.height() - 2);
  const CellPosition at =
      drawBox(picture, model.game.empty() ? "Help" : std::string("Help: ") + model.game, inner, rows);
  for (int i = 0; i < rows; ++i) picture.write(at.x, at.y + i, lines[static_cast<std::size_t>(i)], inner);
}

}  // namespace

ScreenLayout layOut(const ScreenModel& model, int columns, int rows) {
  ScreenLayout layout{Picture(columns, rows), {}};
  Picture& picture = layout.picture;
  if (columns < kMinColumns || rows < kMinRows) {
    drawTooSmall(picture);
    return layout;
  }
  if (!model.has_view) {
    drawBanner(picture, model.banner, rows / 2);
    return layout;
  }
  layout.placement =
      placeView(columns, rows, model.view.width(), model.view.height(), model.focus, model.status_shown);
  drawView(picture, model, layout.placement);
  drawChat(picture, model, rows - (layout.placement.status_row ? 2 : 1));
  if (model.panel == Panel::kPlayers) drawPlayers(picture, model);
  if (model.panel == Panel::kHelp) drawHelp(picture, model);
  if (layout.placement.status_row) {
    drawStatusRow(picture, model);
  } else if (model.status_shown && !model.chat_open) {
    drawStatusOverlay(picture, model);
  }
  drawBanner(picture, model.banner, 0);
  return layout;
}

}  // namespace naiad
