// A field of obstacles in this project's engine, and the one that is sent through it.
#pragma once

#include "Casts.h"
#include "engine/world/World.h"

namespace bench {

class Runner;

class Course {
 public:
  explicit Course(const Field& field);
  ~Course();
  Course(const Course&) = delete;
  Course& operator=(const Course&) = delete;

  /// Put the runner where the cast begins.
  void place(const Cast& cast);
  /// Place it, and ask whom it would meet (WM.firstContact).
  Answer ask(const Cast& cast);
  /// Place it, and have it move (WM.moveObject), swept: whom it met and where it stopped. When, nobody is
  /// told.
  Answer move(const Cast& cast);
  /// Would the book's test, at the end of the way, find somebody?
  bool isBlockedAtEnd(const Cast& cast);

 private:
  std::uint32_t numberOf(const df::Object* p_object) const;

  df::World m_world;
  df::World::Scope m_scope;
  int m_first_id = 0;  // of the obstacles, which are numbered from there
  Runner* m_p_runner;  // the world's
};

}  // namespace bench
