#include "host/admin/BanSet.h"

#include <algorithm>
#include <tuple>

#include "host/session/LookAlikes.h"
#include "shared/admin/TimeSpan.h"
#include "shared/net/base/AddressPrefix.h"

namespace naiad {

std::string banSentence(const Ban& ban) {
  std::string sentence = "You are banned from this server";
  if (ban.until) sentence += " until " + timeText(*ban.until);
  return sentence + (ban.reason.empty() ? "." : ": " + ban.reason);
}

void BanSet::Index::add(const AddressRange& range, std::size_t ban) {
  places.push_back({range.length(), range.bytes(), ban});
  if (std::find(lengths.begin(), lengths.end(), range.length()) == lengths.end())
    lengths.push_back(range.length());
}

void BanSet::Index::sort() {
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    return std::tie(a.length, a.bytes) < std::tie(b.length, b.bytes);
  });
  std::sort(lengths.begin(), lengths.end());
}

BanSet::BanSet(std::vector<Ban> bans) : m_bans(std::move(bans)) {
  for (std::size_t i = 0; i < m_bans.size(); ++i) {
    const Ban& ban = m_bans[i];
    if (ban.kind == Ban::Kind::kRange) m_ranges.add(*ban.range, i);
    if (ban.kind == Ban::Kind::kException) m_exceptions.add(*ban.range, i);
    if (ban.kind != Ban::Kind::kName) continue;
    for (std::string& shape : shapesOf(ban.name)) m_shapes.emplace_back(std::move(shape), i);
  }
  m_ranges.sort();
  m_exceptions.sort();
  std::sort(m_shapes.begin(), m_shapes.end());
}

const Ban* BanSet::findIn(const Index& index, const asio::ip::address& address, Ban::Time now) const {
  const AddressRange::Bytes bytes = AddressRange::bytesOf(address);
  for (const int length : index.lengths) {
    const Place wanted{length, AddressRange::masked(bytes, length), 0};
    const auto found = std::lower_bound(index.places.begin(), index.places.end(), wanted,
                                        [](const Place& a, const Place& b) {
                                          return std::tie(a.length, a.bytes) < std::tie(b.length, b.bytes);
                                        });
    if (found == index.places.end() || found->length != length || found->bytes != wanted.bytes) continue;
    const Ban& ban = m_bans[found->ban];  // one for each range, so a longer one is what may hold instead
    if (!ban.isOver(now) && ban.range->contains(address)) return &ban;
  }
  return nullptr;
}

const Ban* BanSet::find(const asio::ip::address& address, Ban::Time now) const {
  const asio::ip::address own = unmapped(address);
  if (m_ranges.places.empty() || own.is_loopback()) return nullptr;
  const Ban* const p_ban = findIn(m_ranges, own, now);
  if (p_ban == nullptr || findIn(m_exceptions, own, now) != nullptr) return nullptr;
  return p_ban;
}

const Ban* BanSet::findName(const std::vector<std::string>& shapes, Ban::Time now) const {
  for (const std::string& shape : shapes) {
    auto found = std::lower_bound(m_shapes.begin(), m_shapes.end(), std::pair(shape, std::size_t{0}));
    for (; found != m_shapes.end() && found->first == shape; ++found) {
      if (!m_bans[found->second].isOver(now)) return &m_bans[found->second];
    }
  }
  return nullptr;
}

}  // namespace naiad
