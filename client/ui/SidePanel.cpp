#include "client/ui/SidePanel.h"

#include <algorithm>
#include <utility>

#include "shared/net/base/SafeText.h"
#include "shared/values/Canvas.h"

namespace naiad {

namespace {

// With these the texts are worth reading; beyond the second they only spread out.
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

/// Where the explanation of a line like "Ctrl-] h   this help" begins, for lines that continue it.
std::size_t indentOf(const std::u32string& line, std::size_t width) {
  const std::size_t gap = line.find(U"  ");
  const std::size_t text = gap != std::u32string::npos ? line.find_first_not_of(U' ', gap) : gap;
  return text != std::u32string::npos && text <= width / 2 ? text : 2;
}

/// A heading, and a rule to the right edge.
void drawHeading(Picture& picture, const std::string& title, int x, int y, int width) {
  int at = picture.write(x, y, title + " ", width, df::COLOR_DEFAULT, Style::kBold);
  for (; at < x + width; ++at) picture.put(at, y, {U'─'});
}

int drawPlayerRows(Picture& picture, const ScreenModel& model, int x, int y, int width, int most) {
  const std::vector<PlayerLine> players = byScore(model.players);
  drawHeading(picture, "Players", x, y++, width);
  const int count = static_cast<int>(players.size());
  const int shown = count <= most ? count : most - 1;
  for (int i = 0; i < shown; ++i, ++y) {
    const PlayerLine& player = players[static_cast<std::size_t>(i)];
    const Style style = player.player == model.self ? Style::kBold : Style::kPlain;
    const std::string points = std::to_string(player.score);
    picture.write(x, y, player.name, width - columnsIn(points) - 1, player.color, style);
    picture.write(x + width - columnsIn(points), y, points, columnsIn(points), df::COLOR_DEFAULT, style);
  }
  if (shown < count) picture.write(x, y++, "and " + std::to_string(count - shown) + " more", width);
  return y + 1;
}

/// Bottom up; returns the first row above.
int drawHelpRows(Picture& picture, const ScreenModel& model, int x, int bottom, int width, int most) {
  std::vector<std::string> lines;
  for (const std::string& line : model.help) wrapInto(lines, line, static_cast<std::size_t>(width));
  const std::string all = "Ctrl-] h   all keys";
  const std::size_t room = static_cast<std::size_t>(std::max(most - 1, 0));
  if (lines.size() > room) lines.resize(room);
  lines.push_back(all);
  int y = bottom - static_cast<int>(lines.size()) + 1;
  drawHeading(picture, "Help", x, y - 1, width);
  for (const std::string& line : lines) picture.write(x, y++, line, width);
  return bottom - static_cast<int>(lines.size()) - 2;
}

}  // namespace

std::vector<PlayerLine> byScore(std::vector<PlayerLine> players) {
  std::stable_sort(players.begin(), players.end(),
                   [](const PlayerLine& a, const PlayerLine& b) { return a.score > b.score; });
  return players;
}

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

void drawChatRow(Picture& picture, const ChatRow& row, int x, int y, int width) {
  picture.write(x, y, row.text, width);
  if (!row.first) return;
  const std::string& name = row.p_entry->name;
  picture.write(x, y, name.empty() ? "*" : name + ":", width, row.p_entry->color, Style::kBold);
}

int sidePanelColumns(int columns, int rows, const ScreenModel& model) {
  const int room = columns - model.view.width() - 2;  // of its frame
  if (model.browser || !model.status_shown || rows < kMinPanelRows || rows < model.view.height() ||
      room < kMinPanelColumns)
    return 0;
  return std::min(room, kMaxPanelColumns);
}

void drawSidePanel(Picture& picture, const ScreenModel& model, int x, int rows, int& max_scroll) {
  const int left = x + 1;
  const int width = picture.width() - left - 1;
  const int top = drawPlayerRows(picture, model, left, 0, width, rows / 3);
  const int bottom = drawHelpRows(picture, model, left, rows - 1, width, rows / 3);
  drawHeading(picture, "Chat", left, top, width);
  const int room = bottom - top;
  // A page more than is shown: so far it can be scrolled on.
  const std::vector<ChatRow> lines = chatRows(model.history, width, 2 * room + model.chat_scroll);
  const int count = static_cast<int>(lines.size());
  max_scroll = std::max(count - room, 0);
  const int end = count - std::clamp(model.chat_scroll, 0, max_scroll);
  const int first = std::max(end - room, 0);
  for (int i = first; i < end; ++i) {
    drawChatRow(picture, lines[static_cast<std::size_t>(i)], left, top + 1 + i - first, width);
  }
  if (count == 0) picture.write(left, top + 1, "Ctrl-] t   say something", width);
}

}  // namespace naiad
