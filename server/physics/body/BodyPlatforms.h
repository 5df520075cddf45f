// Kinematic bodies that touch and move together act as one obstacle, as Objects do (BoxUnion.h).
#pragma once

#include <span>
#include <vector>

#include "physics/body/BlockContacts.h"
#include "physics/body/BodyState.h"
#include "physics/body/BoxUnion.h"
#include "physics/geometry/Index.h"

namespace naiad::physics {

class BodyPlatforms {
 public:
  struct Platform {
    BoxUnion::Block shape;    ///< relative to the place of its group's first body
    int serial = 0;           ///< lasts as long as the shape and the bodies
    std::uint64_t order = 0;  ///< order of the body from which it was found, and the side of it
    int side = 0;
    int first = 0, last = 0;  ///< the bodies of its group, in members()
  };

  /// Finds the platforms, and sets is_merged in the states of their bodies.
  void find(const WorldStore& store, const BodyTable& table, std::vector<BodyState>& states);
  const std::vector<Platform>& all() const { return m_platforms; }
  bool isEmpty() const { return m_platforms.empty(); }
  std::span<const BlockContacts::Member> members(const Platform& platform) const {
    return std::span(m_members).subspan(at(platform.first), at(platform.last - platform.first));
  }
  /// Returns the index of the state of member number `i` of a platform's group.
  int stateOf(const Platform& platform, int i) const { return m_states_of[at(platform.first + i)]; }
  /// True if the platform has a part of this body of its group.
  static bool hasPart(const Platform& platform, const BlockContacts::Member& member);

 private:
  using Member = BlockContacts::Member;
  struct Group {
    int first, last;            // in m_members
    std::size_t platforms = 0;  // number of its platforms, after those of the groups before
  };
  void addGroup(std::vector<BodyState>& states, Group group);
  bool findAgain(Group& group);
  void search(Group& group);

  std::vector<int> m_found;  // states of bodies that may be merged
  std::vector<Member> m_members, m_members_before;
  std::vector<int> m_states_of;  // by member
  std::vector<Group> m_groups, m_groups_before;
  std::vector<Platform> m_platforms, m_platforms_before;
  std::vector<BoxArea> m_areas;
  BoxUnion m_union;
  int m_serial = 0;
};

}  // namespace naiad::physics
