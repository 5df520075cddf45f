#include "Judge.h"

#include <cstdio>

#include "engine/world/Capture.h"

namespace naiad::soak {

namespace {

constexpr int kMaxAge = 90;        ///< ticks that an undecided picture is kept
constexpr int kMaxDescribed = 12;  ///< maximum number of wrong pictures that are printed

std::string describe(const df::Canvas& seen, const df::Canvas& truth) {
  int told = 0;
  std::string text;
  for (int y = 0; y < truth.height(); ++y) {
    for (int x = 0; x < truth.width(); ++x) {
      if (seen.at(x, y) == truth.at(x, y) || ++told > 8) continue;
      std::string a, b;
      df::appendUtf8(a, seen.at(x, y).ch);
      df::appendUtf8(b, truth.at(x, y).ch);
      std::array<char, 96> line{};
      std::snprintf(line.data(), line.size(), "\n  (%d,%d) seen '%s' colour %d, true '%s' colour %d", x, y,
                    a.c_str(), static_cast<int>(seen.at(x, y).color), b.c_str(),
                    static_cast<int>(truth.at(x, y).color));
      text += line.data();
    }
  }
  return text;
}

}  // namespace

void Judge::keepTruths() {
  const std::uint32_t tick = m_world.picture().view().tick;
  for (const df::PlayerFacts& player : m_world.picture().view().players) {
    if (!isDue(tick, player.id)) continue;
    m_accounts[player.id].truths[tick / m_stride % kTruths] = {tick,
                                                               m_world.picture().renderPlayer(player.id)};
  }
  if (tick % 300 != 0) return;
  std::erase_if(m_accounts, [this](const auto& item) { return m_host.find(item.first) == nullptr; });
}

void Judge::look(Bot& bot, const SnapshotHeader& header, const AckWindow& acks) {
  if (!header.complete || header.number != acks.newest || !isDue(header.tick, bot.player())) return;
  const auto found = m_accounts.find(bot.player());
  if (found == m_accounts.end()) return;
  Account& account = found->second;
  const Truth& truth = account.truths[header.tick / m_stride % kTruths];
  if (truth.tick != header.tick) return;
  const Replica& replica = bot.session()->replica();
  const df::Canvas seen = replica.render(header.tick);
  const int wrong = countDifferences(seen, truth.picture);
  Waiting waiting{acks, replica.checksum(), header.tick, wrong, seen.width() * seen.height(), 0, {}};
  if (wrong > 0) {
    waiting.text =
        "snapshot " + std::to_string(header.number) + ", " + bot.describe() + describe(seen, truth.picture);
  }
  if (!settle(bot.player(), account, waiting)) account.waiting.push_back(std::move(waiting));
}

// Returns false if the picture cannot be judged yet.
bool Judge::settle(std::uint32_t player, Account& account, const Waiting& waiting) {
  const Session* session = m_host.find(player);
  if (session == nullptr) return true;
  const std::optional<bool> right = session->sender().matchesChecksum(waiting.acks, waiting.checksum);
  if (!right) return false;
  if (!*right) ++m_tally.wrong_checksums;
  ++m_tally.compared;
  m_tally.compared_cells += static_cast<std::uint64_t>(waiting.cells);
  m_tally.wrong_cells += static_cast<std::uint64_t>(waiting.wrong);
  account.right_in_a_row = waiting.wrong == 0 ? account.right_in_a_row + 1 : 0;
  if (waiting.wrong > 0 || !*right) {
    if (++m_described > kMaxDescribed) return true;
    std::fprintf(stderr, "player %u tick %u: %d wrong cells, checksum %s; %s\n", player, waiting.tick,
                 waiting.wrong, *right ? "right" : "wrong", waiting.text.c_str());
  }
  return true;
}

void Judge::judge() {
  for (auto& [player, account] : m_accounts) {
    std::erase_if(account.waiting, [&, id = player, &own = account](Waiting& waiting) {
      return settle(id, own, waiting) || ++waiting.age > kMaxAge;
    });
  }
}

std::uint64_t Judge::rightInARow(std::uint32_t player) const {
  const auto found = m_accounts.find(player);
  return found != m_accounts.end() ? found->second.right_in_a_row : 0;
}

std::size_t Judge::bytesKept() const {
  std::size_t bytes = 0;
  for (const auto& [player, account] : m_accounts) {
    bytes += sizeof account + account.waiting.size() * sizeof(Waiting);
    for (const Truth& truth : account.truths)
      bytes += static_cast<std::size_t>(truth.picture.width() * truth.picture.height()) * sizeof(df::Cell);
  }
  return bytes;
}

}  // namespace naiad::soak
