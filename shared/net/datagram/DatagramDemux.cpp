#include "shared/net/datagram/DatagramDemux.h"

#include <utility>

#include "shared/net/datagram/SealedHeader.h"

namespace naiad {

bool DatagramDemux::add(SealedLink& link, OnPayload on_payload) {
  const auto [place, added] = registrations_.try_emplace(link.id());
  if (added) {
    place->second.link = &link;
    place->second.on_payload = std::move(on_payload);
  }
  return added;
}

void DatagramDemux::remove(ConnectionId id) {
  const auto found = registrations_.find(id);
  if (found == registrations_.end()) return;
  if (&found->second == open_) {  // this session's callback runs now, see receive()
    leaving_ = registrations_.extract(found);
  } else {
    registrations_.erase(found);
  }
}

void DatagramDemux::receive(const Path& path, std::string_view packet, Time now) {
  SealedHeader header;
  switch (readSealedHeader(SealDirection::kClientToServer, packet, header)) {
    case HeaderFault::kTooShort:
      ++counters_.too_short;
      return;
    case HeaderFault::kTooLong:
      ++counters_.too_long;
      return;
    case HeaderFault::kKind:
      ++counters_.bad_kind;
      return;
    case HeaderFault::kNone:
      break;
  }
  const auto found = registrations_.find(header.id);
  if (found == registrations_.end()) {
    ++counters_.unknown_id;
    return;
  }
  Registration& door = found->second;
  if (!door.link->isPlausible(packet, now)) {
    ++counters_.refused;
    return;
  }
  if (!allowed(door, path, now)) return;
  const auto payload = door.link->open(path, packet, now);
  if (!payload) {
    ++counters_.refused;
    return;
  }
  ++counters_.delivered;
  open_ = &door;
  door.on_payload(*payload);
  open_ = nullptr;
  leaving_ = {};
}

/// Checks the narrowest bucket first, so that a flood uses as few shared tokens as possible.
bool DatagramDemux::allowed(Registration& door, const Path& path, Time now) {
  if (door.link->isValidated(path)) {
    if (door.own.tryConsume(rates_.session, now)) return true;
    ++counters_.session_flood;
  } else if (!door.claimed.tryConsume(rates_.claimed, now)) {
    ++counters_.unvalidated_session_flood;
  } else if (!prefixes_.use(path.remote.prefix()).tryConsume(rates_.prefix, now)) {
    ++counters_.prefix_flood;
  } else if (!strangers_.tryConsume(rates_.strangers, now)) {
    ++counters_.unvalidated_flood;
  } else {
    return true;
  }
  return false;
}

}  // namespace naiad
