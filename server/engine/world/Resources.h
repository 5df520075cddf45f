// The sprites, sounds and music of one world. ResourceManager.h documents the functions.
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

/// Returns the file in `folder` (empty: the working directory) that `name` would name if a backslash
/// separated folders and the case of ASCII letters did not matter, as on Windows. If several match, returns
/// the first by name; if none does, an empty string.
std::string findCaseInsensitive(const std::string& folder, const std::string& name);

/// The sounds, or the pieces of music, of one world.
template <class T>
class SoundBank {
 public:
  /// `get` is the name of ResourceManager's function that finds a T, for log lines.
  SoundBank(WorldLog& log, const WorldState& state, const char* get)
      : m_log(log), m_state(state), m_get(get) {}
  /// Returns 0, or -1 for a file that cannot be read. With compat, the label then has a silent T until a
  /// load() of this label succeeds, because games ignore the result and play what find() returns.
  int load(const std::string& filename, const std::string& label);
  int unload(const std::string& label);
  T* find(const std::string& label);
  /// Like find(). For an unknown label, logs a line and returns a T that plays nothing (compat: null).
  T* findOrPlaceholder(const std::string& label);
  void clear() { m_all.clear(); }

 private:
  WorldLog& m_log;
  const WorldState& m_state;
  const char* m_get;
  std::list<T> m_all;              // a list, because games keep pointers
  std::unique_ptr<T> m_p_missing;  // made at first use
};

class Resources {
 public:
  Resources(WorldLog& log, const WorldState& state)
      : m_log(log), m_state(state), m_sounds(log, state, "getSound"), m_musics(log, state, "getMusic") {}

  int loadSprite(const std::string& filename, const std::string& label);
  int unloadSprite(const std::string& label);
  Sprite* sprite(const std::string& label) const;
  /// Like sprite(). If the sprite's file could not be loaded, returns a sprite that shows a '?' (compat:
  /// null). If no file was loaded under the label, returns null, which a later crash report mentions.
  Sprite* spriteOrPlaceholder(const std::string& label);
  /// Returns the sprite that shows a '?'.
  Sprite& missingSprite();
  /// Returns the loaded labels, at most 12, as text for a log line: "; loaded: saucer, ship".
  std::string spriteLabels() const;
  SoundBank<Sound>& sounds() { return m_sounds; }
  SoundBank<Music>& musics() { return m_musics; }

  /// Removes all sprites' labels, and all sounds and music. Keeps sprites, because Objects may show them.
  void clear();
  /// Adds a folder. Relative names are looked for in the working directory, then in the folders in order of
  /// the calls. clear() keeps the folders.
  void addFolder(std::string folder) { m_folders.push_back(std::move(folder)); }
  /// Returns the contents of the file; nullopt if it cannot be read.
  std::optional<std::string> read(const std::string& filename) const;
  /// Returns the searched folders as text for a log line: "; looked in /home/ann/game, /usr/…". Returns ""
  /// for an absolute name.
  std::string searchedFolders(const std::string& filename) const;
  /// True if the file can be read.
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
  std::set<std::string> m_failed_sprites;    // labels whose file could not be loaded
  std::unique_ptr<Sprite> m_missing_sprite;  // made at first use
};

}  // namespace df
