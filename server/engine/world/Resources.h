// The sprites, sounds and music of one world. ResourceManager.h says what the functions do.
#pragma once

#include <list>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "engine/sprites/Sprite.h"
#include "engine/world/Music.h"
#include "engine/world/Sound.h"

namespace df {

class World;

class Resources {
 public:
  explicit Resources(World& world) : m_world(world) {}

  int loadSprite(const std::string& filename, const std::string& label);
  int unloadSprite(const std::string& label);
  Sprite* sprite(const std::string& label) const;
  /// The same. If its file could not be loaded: one that shows a '?'. If none was: null, and a report of a
  /// crash says so. Null in compat.
  Sprite* spriteOrStandIn(const std::string& label);
  /// The one that stands in.
  Sprite& missingSprite();
  /// For a line in the log: "; loaded are: saucer, ship".
  std::string spriteLabels() const;
  int loadSound(const std::string& filename, const std::string& label);
  int unloadSound(const std::string& label);
  Sound* sound(const std::string& label);
  /// The same; if there is none, one that plays nothing, and a line in the log. Null in compat.
  Sound* soundOrStandIn(const std::string& label);
  int loadMusic(const std::string& filename, const std::string& label);
  int unloadMusic(const std::string& label);
  Music* music(const std::string& label);
  Music* musicOrStandIn(const std::string& label);

  /// Labels mean nothing any more; sprites live on, for Objects may still show them.
  void clear();
  /// Relative names are looked for in the working directory, then here, in order of the calls.
  void addFolder(std::string folder) { m_folders.push_back(std::move(folder)); }
  /// What is in the file; nothing if it cannot be read.
  std::optional<std::string> read(const std::string& filename) const;
  /// For a line in the log about a file that is not there: "; looked in /home/ann/game, /usr/…". Empty for an
  /// absolute name.
  std::string lookedIn(const std::string& filename) const;
  /// Can it be read?
  bool open(const std::string& filename) const;

 private:
  std::string locate(const std::string& filename) const;
  std::unique_ptr<Sprite> readSprite(const std::string& filename, const std::string& label);
  bool standsIn(const char* call, const std::string& label, const std::string& loaded);

  World& m_world;
  std::vector<std::string> m_folders;
  std::vector<std::unique_ptr<Sprite>> m_sprites;
  std::vector<std::unique_ptr<Sprite>> m_unloaded;  // Objects may still show them
  std::list<Sound> m_sounds;                        // games keep pointers
  std::list<Music> m_musics;
  std::set<std::string> m_failed_sprites;  // labels
  // For labels of which nothing is loaded. Made at first use.
  std::unique_ptr<Sprite> m_missing_sprite;
  std::unique_ptr<Sound> m_missing_sound;
  std::unique_ptr<Music> m_missing_music;
};

}  // namespace df
