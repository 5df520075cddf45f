#include "client/ui/ServerMenu.h"

#include <algorithm>
#include <array>
#include <sstream>

#include "shared/net/base/Limits.h"

namespace naiad {
namespace {

namespace key = df::Keyboard;

constexpr int kHeadRows = 3;  // title, blank, names of the columns
constexpr int kFootRows = 3;  // blank, address, keys

constexpr const char* kMenuKeys = "Enter join   Up/Down choose   r refresh   q leave";

/// Widths of the columns for name, game and places; the note gets the remaining columns.
struct Widths {
  int name = 0;
  int game = 0;
  int places = 12;
};

Widths widthsFor(int columns) {
  const int texts = std::clamp(columns - 26, 12, 56);
  return {texts * 4 / 7, texts * 3 / 7};
}

void writeColumns(ScreenBuffer& picture, int y, const std::array<std::string, 4>& texts, df::Color color,
                  Style style) {
  const Widths widths = widthsFor(picture.width());
  int x = 2;
  const std::array<int, 4> each{widths.name, widths.game, widths.places, picture.width()};
  for (std::size_t i = 0; i < texts.size(); ++i) {
    picture.write(x, y, texts[i], each[i] - 1, color, style);
    x += each[i];
  }
}

/// Breaks a text at blanks into lines of at most `columns` bytes; a longer word is a line of its own.
std::vector<std::string> wrapped(const std::string& text, int columns) {
  std::vector<std::string> lines{""};
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    std::string& line = lines.back();
    if (line.empty()) {
      line = word;
    } else if (line.size() + 1 + word.size() <= static_cast<std::size_t>(std::max(columns, 1))) {
      line += " " + word;
    } else {
      lines.push_back(word);
    }
  }
  return lines;
}

}  // namespace

void ServerMenu::setServers(std::vector<DiscoveredServer> servers) {
  const DiscoveredServer* p_before = chosen();
  const auto key_before = p_before != nullptr ? std::optional(p_before->key) : std::nullopt;
  m_servers = std::move(servers);
  const auto found = std::find_if(
      m_servers.begin(), m_servers.end(),
      [&key_before](const DiscoveredServer& server) { return key_before && server.key == *key_before; });
  if (found == m_servers.end()) m_message.clear();
  m_chosen = found == m_servers.end() ? 0 : static_cast<int>(found - m_servers.begin());
}

const DiscoveredServer* ServerMenu::chosen() const {
  return m_servers.empty() ? nullptr : &m_servers[static_cast<std::size_t>(m_chosen)];
}

ServerMenu::Result ServerMenu::choose(int index) {
  m_message.clear();
  const int last = static_cast<int>(m_servers.size()) - 1;
  m_chosen = std::clamp(index, 0, std::max(last, 0));
  return Result::kRedraw;
}

ServerMenu::Result ServerMenu::joinChosen() {
  const DiscoveredServer* p_server = chosen();
  if (p_server == nullptr) return Result::kNone;
  if (p_server->isPlayable()) return Result::kJoin;
  m_message = "Incompatible: server protocol version " + std::to_string(p_server->protocol) +
              ", client version " + std::to_string(kProtocolVersion) + ".";
  return Result::kRedraw;
}

ServerMenu::Result ServerMenu::handleKey(const KeyEvent& event) {
  if (event.action == KeyEvent::Action::kRelease) return Result::kNone;
  if ((event.modifiers & kControl) != 0) {
    if (event.key == key::C) return Result::kLeave;
    return event.key == key::Z ? Result::kSuspend : Result::kNone;
  }
  const df::Keyboard::Key pressed = event.key;
  if (pressed == key::UPARROW || pressed == key::K) return choose(m_chosen - 1);
  if (pressed == key::DOWNARROW || pressed == key::J) return choose(m_chosen + 1);
  if (pressed == key::PAGEUP) return choose(m_chosen - m_page);
  if (pressed == key::PAGEDOWN) return choose(m_chosen + m_page);
  if (pressed == key::HOME) return choose(0);
  if (pressed == key::END) return choose(static_cast<int>(m_servers.size()) - 1);
  if (pressed == key::RETURN) return joinChosen();
  if (pressed == key::R) return Result::kRefresh;
  return pressed == key::Q || pressed == key::ESCAPE ? Result::kLeave : Result::kNone;
}

void ServerMenu::writeRow(ScreenBuffer& picture, int y, const DiscoveredServer& server,
                          bool is_chosen) const {
  const Style style = is_chosen ? Style::kReverse : Style::kPlain;
  if (is_chosen) {
    picture.fill(0, y, picture.width(), 1, style);
    picture.put(0, y, {U'>', df::COLOR_DEFAULT, style});
  }
  writeColumns(picture, y, {server.name, server.game, occupancyText(server), restrictionsText(server)},
               df::COLOR_DEFAULT, style);
}

void ServerMenu::writeEmpty(ScreenBuffer& picture) const {
  if (m_searching) {
    picture.write(2, kHeadRows - 1, "Looking ...", picture.width() - 2);
    return;
  }
  int y = kHeadRows - 1;
  for (const std::string& text : m_empty) {
    for (const std::string& line : wrapped(text, picture.width() - 4))
      picture.write(2, y++, line, picture.width() - 2);
    ++y;
  }
}

ScreenBuffer ServerMenu::compose(int columns, int rows) {
  ScreenBuffer picture(columns, rows);
  picture.write(2, 0, m_title, columns - 2, df::COLOR_DEFAULT, Style::kBold);
  picture.write(2, rows - 1, kMenuKeys, columns - 2);
  if (m_servers.empty()) {
    writeEmpty(picture);
    picture.write(2, rows - 1, kMenuKeys, columns - 2);
    return picture;
  }
  writeColumns(picture, kHeadRows - 1, {"NAME", "GAME", "PLAYERS", "NOTE"}, df::COLOR_DEFAULT, Style::kBold);
  m_page = std::max(rows - kHeadRows - kFootRows, 1);
  m_first = std::clamp(m_first, m_chosen - m_page + 1, m_chosen);
  m_first = std::max(m_first, 0);
  for (int i = m_first; i < static_cast<int>(m_servers.size()) && i < m_first + m_page; ++i)
    writeRow(picture, kHeadRows + i - m_first, m_servers[static_cast<std::size_t>(i)], i == m_chosen);
  const DiscoveredServer& server = *chosen();
  const std::string below =
      m_message.empty() ? server.address.text() + "   key " + server.key.text() : m_message;
  if (rows >= kHeadRows + kFootRows) picture.write(2, rows - 2, below, columns - 2);
  return picture;
}

}  // namespace naiad
