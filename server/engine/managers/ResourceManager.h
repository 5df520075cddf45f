// Loads sprites, sounds and music and keeps them by their labels (book, Listings 4.141 and 4.172).
//
// Files are searched for in the working directory, then in the folders that the host has added. An error in a
// file is logged with the file's name and the line. A label in use keeps the resource that was loaded first.
#pragma once

#include <string>

#include "Manager.h"
#include "Music.h"
#include "Sound.h"
#include "Sprite.h"
#include "StandardHeaders.h"

/// The resource manager.
#define RM df::ResourceManager::getInstance()

namespace df {

/// The published engine's limits, for games that use the names. Naiad does not limit the numbers.
inline constexpr int MAX_SPRITES = 1000;
inline constexpr int MAX_SOUNDS = 50;
inline constexpr int MAX_MUSICS = 50;

class ResourceManager : public Manager {
 public:
  /// Returns the only instance; RM is short for it. It acts on the current world.
  static ResourceManager& getInstance();

  /// Loads a sprite in one of the three formats (SpriteFile.h). Returns 0, or -1 if it cannot be loaded.
  int loadSprite(const std::string& filename, const std::string& label);
  /// Removes a sprite's label; Objects that show the sprite keep it. Returns 0, or -1 for an unknown label.
  int unloadSprite(const std::string& label);
  /// Returns the sprite; null for an unknown label. If its file could not be loaded, returns a sprite that
  /// shows a '?' (compat: null).
  Sprite* getSprite(const std::string& label) const;

  /// Loads a sound. Returns 0, or -1 for a file that cannot be read (compat: the label then has a silent
  /// sound).
  int loadSound(const std::string& filename, const std::string& label);
  /// Unloads a sound. Returns 0, or -1 for an unknown label.
  int unloadSound(const std::string& label);
  /// Returns the sound. For an unknown label, logs a line and returns a silent sound (compat: null).
  Sound* getSound(const std::string& label);

  /// Loads a piece of music. Returns 0, or -1 for a file that cannot be read (compat: as for a sound).
  int loadMusic(const std::string& filename, const std::string& label);
  /// Unloads a piece of music. Returns 0, or -1 for an unknown label.
  int unloadMusic(const std::string& label);
  /// Returns the music. For an unknown label, logs a line and returns silent music (compat: null).
  Music* getMusic(const std::string& label);

 private:
  ResourceManager();
};

}  // namespace df
