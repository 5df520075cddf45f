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

class WorldLog;
struct WorldState;

// Finds files by names as on systems that separate folders by backslashes and ignore case.

/// The file in `folder` (empty: the working directory) that `name`, a path relative to it, means there: a
/// backslash parts folders, letters of ASCII count without their case. Of several, the one that comes first
/// by name; empty if there is none.
std::string findLoosely(const std::string& folder, const std::string& name);

/// The sounds, or the pieces of music, of one world.
template <class T>
class SoundBank {
 public:
  /// `get`: the function of ResourceManager that looks one up, for lines in the log.
  SoundBank(WorldLog& log, const WorldState& state, const char* get)
      : m_log(log), m_state(state), m_get(get) {}
  int load(const std::string& filename, const std::string& label);
  int unload(const std::string& label);
  T* find(const std::string& label);
  /// The same; if there is none, one that plays nothing, and a line in the log. Null in compat.
  T* findOrStandIn(const std::string& label);
  void clear() { m_all.clear(); }

 private:
  WorldLog& m_log;
  const WorldState& m_state;
  const char* m_get;
  std::list<T> m_all;              // games keep pointers
  std::unique_ptr<T> m_p_missing;  // made at first use
};

class Resources {
 public:
  Resources(WorldLog& log, const WorldState& state)
      : m_log(log), m_state(state), m_sounds(log, state, "getSound"), m_musics(log, state, "getMusic") {}

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
  SoundBank<Sound>& sounds() { return m_sounds; }
  SoundBank<Music>& musics() { return m_musics; }

  /// Labels mean nothing any more; sprites live on, for Objects may still show them.
  void clear();
  /// Relative names are looked for in the working directory, then here, in order of the calls. It stays
  /// through clear().
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

  WorldLog& m_log;
  const WorldState& m_state;
  std::vector<std::string> m_folders;
  std::vector<std::unique_ptr<Sprite>> m_sprites;
  std::vector<std::unique_ptr<Sprite>> m_unloaded;  // Objects may still show them
  SoundBank<Sound> m_sounds;
  SoundBank<Music> m_musics;
  std::set<std::string> m_failed_sprites;    // labels
  std::unique_ptr<Sprite> m_missing_sprite;  // made at first use
};

}  // namespace df
