// What is connected to the gateway: a browser that reads the page, or one stream of a player.
//
// Each has one time by which something has to have come. They are compared in one sweep, so that no message
// costs a timer.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <unordered_set>
#include <utility>
#include <vector>

namespace naiad {

class Guests;

/// Make it with std::make_shared; the handlers under way keep it alive.
class Guest : public std::enable_shared_from_this<Guest> {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// `guests` are kept as long as this.
  explicit Guest(std::shared_ptr<Guests> guests);
  virtual ~Guest();
  Guest(const Guest&) = delete;
  Guest& operator=(const Guest&) = delete;

  /// Its time is over.
  virtual void onDeadline() = 0;
  /// The gateway ends: leave, saying so where that can be.
  virtual void endService() = 0;
  /// End at once; its places are given back when this returns.
  virtual void hangUp() = 0;

  /// Ten times a second. Calls onDeadline() when it is time.
  virtual void onSweep(Time now) {
    if (m_deadline <= now) onDeadline();
  }

 protected:
  void setTime(std::chrono::milliseconds time) { m_deadline = std::chrono::steady_clock::now() + time; }
  void setNoTime() { m_deadline = Time::max(); }
  template <class Self>
  static std::shared_ptr<Self> sharedFrom(Self* self) {
    return std::static_pointer_cast<Self>(self->shared_from_this());
  }

 private:
  std::shared_ptr<Guests> m_guests;
  Time m_deadline = Time::max();
};

/// All of them.
class Guests {
 public:
  void sweep(Guest::Time now) {
    for (const auto& guest : list()) guest->onSweep(now);
  }
  void endService() {
    for (const auto& guest : list()) guest->endService();
  }
  void hangUp() {
    for (const auto& guest : list()) guest->hangUp();
  }
  std::size_t count() const { return m_all.size(); }

 private:
  friend class Guest;
  /// They keep themselves alive; one that is going has nothing left to end.
  std::vector<std::shared_ptr<Guest>> list() const {
    std::vector<std::shared_ptr<Guest>> all;
    all.reserve(m_all.size());
    for (Guest* const guest : m_all) {
      if (auto alive = guest->weak_from_this().lock()) all.push_back(std::move(alive));
    }
    return all;
  }

  std::unordered_set<Guest*> m_all;
};

inline Guest::Guest(std::shared_ptr<Guests> guests) : m_guests(std::move(guests)) {
  m_guests->m_all.insert(this);
}

inline Guest::~Guest() {
  m_guests->m_all.erase(this);
}

}  // namespace naiad
