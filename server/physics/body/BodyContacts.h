// Who of the HARD ones touches whom, whichever solver found it out: so that a body that is handed from one
// solver to another neither hears twice of what it lies on, nor never that it has left it.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/body/BodyPlan.h"

namespace naiad::physics {

class BodyContacts {
 public:
  /// A tick begins.
  void begin();
  /// What a solver found; from each in the order of time. Of no news, nothing is kept.
  void add(const BodyContact& contact);
  /// Somebody is gone: what he touches ends with this tick.
  void doubt(df::ObjectKey key) { doubtFor(key, 1, nullptr); }
  /// The same for what this solver found.
  void doubt(df::ObjectKey key, BodyWay by) { doubtFor(key, 1, &by); }
  /// Somebody was handed to another solver: what he touches ends, unless that one finds it soon.
  void hand(df::ObjectKey key) { doubtFor(key, kPatience, nullptr); }
  /// The tick ends: the news.
  std::vector<BodyContact>& finish();

  /// About the logarithm of how many touch something.
  bool isTouching(df::ObjectKey key) const;
  bool isEmpty() const { return m_touching.empty(); }

 private:
  struct Touch {
    BodyContact contact;
    int doubt = 0;  // ticks until it ends, unless somebody finds it; 0: none
  };
  struct Toucher {
    df::ObjectKey key;
    int count;  // of what it touches
  };
  static constexpr int kPatience = 3;  // a solver may see a touch first, and feel it a tick later
  void doubtFor(df::ObjectKey key, int ticks, const BodyWay* p_by);
  std::vector<Touch>::iterator find(const BodyContact& contact);
  void count(const BodyContact& contact, int by);
  std::vector<Toucher>::const_iterator toucher(df::ObjectKey key) const;

  std::vector<Touch> m_touching;    // by the slots of the two
  std::vector<Toucher> m_touchers;  // by keys
  std::vector<BodyContact> m_news;
};

}  // namespace naiad::physics
