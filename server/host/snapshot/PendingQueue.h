// The order in which one client's pending objects are written, the most urgent first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "host/snapshot/ClientReplica.h"
#include "host/snapshot/Publisher.h"

namespace naiad {

class PendingQueue {
 public:
  /// Take all pending ids: by id if one snapshot of `limit` bytes holds them all, else by urgency.
  void fill(const ClientReplica& replica, const Publisher& publisher, std::size_t limit);
  bool empty() const { return m_ids.empty(); }
  std::uint32_t front() const { return m_ids.back(); }
  void pop() { m_ids.pop_back(); }
  /// Take the front out until restoreDeferred().
  void defer() {
    m_deferred.push_back(m_ids.back());
    m_ids.pop_back();
  }
  void restoreDeferred() {
    m_ids.insert(m_ids.end(), m_deferred.rbegin(), m_deferred.rend());
    m_deferred.clear();
  }

 private:
  std::vector<std::uint32_t> m_ids;  ///< the most urgent last
  std::vector<std::uint32_t> m_deferred;
  std::vector<std::pair<double, std::uint32_t>> m_ranked;  ///< scratch
};

}  // namespace naiad
