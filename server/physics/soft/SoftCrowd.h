// Limits the contacts between soft bodies where too many of them are in one place.
//
// A body is tested node by node against each neighbour. Hundreds in one place would give too many contacts to
// solve. So in a crowd a body touches only the nearest others, and only the deepest contacts with them count;
// it passes through the rest until there is room. The cost of a crowd grows with the number of its bodies,
// not of their pairs. Bodies outside a crowd are not affected.
#pragma once

#include <vector>

#include "physics/soft/SoftContact.h"

namespace naiad::physics {

class SoftCrowd {
 public:
  /// A body with more neighbours than this, and than half its boundary's nodes, is in a crowd. At most this
  /// many contacts of its nodes with them count. (In a plane, six equal bodies fit around one.)
  static constexpr int kMaxOthers = 8;

  /// Appends contacts of the nodes of `views[which]` with other bodies. False if crowding left some out.
  bool findContacts(const std::vector<SoftView>& views, std::size_t which, std::vector<SoftRow>& rows);

 private:
  struct Other {
    std::size_t index;  // index of its view
    double square;      // squared distance
    std::size_t turn;   // tie-breaker: each of several bodies in one place begins with another one
  };
  void gather(const std::vector<SoftView>& views, std::size_t which);

  std::vector<Other> m_others;  // bodies with overlapping bounds
};

}  // namespace naiad::physics
