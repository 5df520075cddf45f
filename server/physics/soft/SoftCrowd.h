// Which contacts with other soft bodies count where too many of them are in one place.
//
// A body among others is tested node by node against each of them. Hundreds in one place would be too many
// contacts to solve for; so in a crowd a body touches only the nearest others, and the deepest of its
// contacts with them count. It passes through the rest until there is room. What a crowd costs grows with the
// number of its bodies, not with the number of their pairs; a body in no crowd is not affected.
#pragma once

#include <vector>

#include "physics/soft/SoftContact.h"

namespace naiad::physics {

class SoftCrowd {
 public:
  /// A body among more others than this, or than half as many as its own nodes, is in a crowd; as many
  /// contacts of its nodes with them count. No more bodies of one size lie around one in a plane than six.
  static constexpr int kMaxOthers = 8;

  /// Appends the contacts of the nodes of `views[which]` with the other bodies. False if it is in a crowd,
  /// and some were left out.
  bool findContacts(const std::vector<SoftView>& views, std::size_t which, std::vector<SoftRow>& rows);

 private:
  struct Other {
    std::size_t index;  // of its view
    double square;      // of the distance
    std::size_t turn;   // of bodies in one place each begins with another one
  };
  void gather(const std::vector<SoftView>& views, std::size_t which);

  std::vector<Other> m_others;  // whose bounds overlap
};

}  // namespace naiad::physics
