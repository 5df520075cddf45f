// Limits the contacts between soft bodies if too many of them are in one place.
//
// A body is tested node by node against each neighbour. Hundreds of bodies in one place would have too many
// contacts to solve. So a body in a crowd touches only its nearest neighbours, and only the deepest contacts
// with them count; it passes through all others until there is room. The cost of a crowd grows with the
// number of its bodies, not of their pairs. Bodies outside a crowd are not affected.
#pragma once

#include <vector>

#include "physics/soft/SoftContact.h"

namespace naiad::physics {

class SoftCrowd {
 public:
  /// A body is in a crowd if it has more neighbours than the larger of this and half the number of its
  /// boundary nodes. Then that number limits its neighbours, and the contacts of its nodes with them. (In a
  /// plane, six equal bodies fit around one.)
  static constexpr int kMaxOthers = 8;

  /// Appends contacts of the nodes of `views[which]` with other bodies. False if crowding dropped some.
  bool findContacts(const std::vector<SoftView>& views, std::size_t which, std::vector<SoftRow>& rows);

 private:
  struct Other {
    std::size_t index;  // index of its view in `views`
    double square;      // square of the distance
    std::size_t turn;   // decides at equal distances; differs between bodies in one place
  };
  void gather(const std::vector<SoftView>& views, std::size_t which);

  std::vector<Other> m_others;  // bodies with overlapping bounds
};

}  // namespace naiad::physics
