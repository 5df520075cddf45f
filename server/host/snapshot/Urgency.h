// How urgently one client needs the record of an object, in cells of distance from the middle of its view.
#pragma once

#include <cstdint>

#include "host/snapshot/ClientReplica.h"
#include "host/snapshot/Publisher.h"

namespace naiad {

class Urgency {
 public:
  Urgency(const ClientReplica& replica, const Publisher& publisher)
      : m_replica(replica), m_publisher(publisher) {}
  double of(std::uint32_t id) const;
  /// Of repeating the record before a loss is known: an object that moves fast is soon wrong.
  double ofRepeating(std::uint32_t id) const;

 private:
  const ClientReplica& m_replica;
  const Publisher& m_publisher;
};

}  // namespace naiad
