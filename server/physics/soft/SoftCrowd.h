// Which contacts with other soft bodies count where too many of them are in one place.
//
// A body among others is looked at node by node against each of them. Hundreds in one place would be more
// contacts than anybody can solve for; so in a crowd a body meets those that are nearest, and of its contacts
// with them the deepest count. It passes through the rest until there is room. What a crowd costs grows with
// the number of its bodies, not with the number of their pairs; and who is in none notices nothing.
#pragma once

#include <vector>

#include "physics/soft/SoftContact.h"

namespace naiad::physics {

class SoftCrowd {
 public:
  /// So many others, or half as many as its own nodes if that is more, make a crowd of one; as many contacts
  /// of its nodes with them count.
  static constexpr int kMaxOthers = 8;

  /// Appends the contacts of the nodes of `views[which]` with the other bodies. False if it is in a crowd,
  /// and some were left out.
  bool findContacts(const std::vector<SoftView>& views, std::size_t which, std::vector<SoftRow>& rows);

 private:
  struct Other {
    std::size_t index;  // of its view
    double square;      // of the distance
    std::size_t turn;   // of those in the same place everybody begins with another one
  };
  void gather(const std::vector<SoftView>& views, std::size_t which);

  std::vector<Other> m_others;  // whose bounds meet
};

}  // namespace naiad::physics
