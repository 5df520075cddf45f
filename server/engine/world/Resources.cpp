#include "engine/world/Resources.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "engine/sprites/CaseInsensitiveFile.h"
#include "engine/sprites/SpriteFile.h"
#include "engine/world/World.h"

namespace df {

namespace {

template <class List>
auto findSound(List& list, const std::string& label) {
  return std::find_if(list.begin(), list.end(), [&](const auto& one) { return one.getLabel() == label; });
}

/// "; loaded are: saucer, ship"
template <class Labels>
std::string loadedAre(const Labels& labels) {
  constexpr std::size_t kMost = 12;
  std::string text;
  std::size_t count = 0;
  for (const std::string& label : labels) {
    if (++count > kMost) return text + ", …";
    text += (text.empty() ? "; loaded are: " : ", ") + label;
  }
  return text.empty() ? "; none is loaded" : text;
}

template <class List>
std::string labelsOf(const List& list) {
  std::vector<std::string> labels;
  for (const auto& one : list) labels.push_back(one.getLabel());
  return loadedAre(labels);
}

std::string nothingLoaded(const char* call, const std::string& label, const std::string& loaded) {
  return "RM." + std::string(call) + "(\"" + label + "\"): nothing is loaded under this label" + loaded;
}

bool isFile(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error);
}

}  // namespace

void Resources::clear() {
  for (auto& p_sprite : m_sprites) m_unloaded.push_back(std::move(p_sprite));
  m_sprites.clear();
  m_failed_sprites.clear();
  m_sounds.clear();
  m_musics.clear();
}

std::string Resources::locate(const std::string& filename) const {
  if (isFile(filename) || std::filesystem::path(filename).is_absolute()) return filename;
  for (const std::string& folder : m_folders) {
    const std::filesystem::path path = std::filesystem::path(folder) / filename;
    if (isFile(path)) return path.string();
  }
  // Games are written where "Sprites\Ship.txt" finds sprites/ship.txt.
  std::string found = findLoosely("", filename);
  for (std::size_t i = 0; i < m_folders.size() && found.empty(); ++i)
    found = findLoosely(m_folders[i], filename);
  return found.empty() ? filename : found;
}

std::string Resources::lookedIn(const std::string& filename) const {
  if (std::filesystem::path(filename).is_absolute()) return {};
  std::error_code error;
  std::string text = "; looked in " + std::filesystem::current_path(error).string();
  for (const std::string& folder : m_folders) text += ", " + folder;
  return text;
}

bool Resources::open(const std::string& filename) const {
  const std::string path = locate(filename);
  return isFile(path) && std::ifstream(path).good();
}

std::optional<std::string> Resources::read(const std::string& filename) const {
  const std::string path = locate(filename);
  if (!isFile(path)) return std::nullopt;  // first: to open a pipe would wait for its writer
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(file), {});
}

int Resources::loadSprite(const std::string& filename, const std::string& label) {
  std::unique_ptr<Sprite> loaded = readSprite(filename, label);
  if (loaded == nullptr) {
    m_failed_sprites.insert(label);
    return -1;
  }
  m_failed_sprites.erase(label);
  if (sprite(label) == nullptr) m_sprites.push_back(std::move(loaded));
  return 0;
}

std::unique_ptr<Sprite> Resources::readSprite(const std::string& filename, const std::string& label) {
  const std::optional<std::string> text = read(filename);
  if (!text) {
    m_world.log("Sprite " + label + ": " + filename + ": cannot be read" + lookedIn(filename));
    return nullptr;
  }
  std::string error;
  std::vector<std::string> oddities;
  std::unique_ptr<Sprite> loaded = parseSprite(*text, label, error, m_world.compat() ? &oddities : nullptr);
  const std::string where = "Sprite " + label + ": " + filename + ":";
  for (const std::string& oddity : oddities) m_world.log(where + oddity + " (compat)");
  if (loaded == nullptr) m_world.log(where + error);
  return loaded;
}

int Resources::unloadSprite(const std::string& label) {
  const auto it = std::find_if(m_sprites.begin(), m_sprites.end(),
                               [&](const auto& p_sprite) { return p_sprite->getLabel() == label; });
  if (it == m_sprites.end()) return -1;
  m_unloaded.push_back(std::move(*it));
  m_sprites.erase(it);
  return 0;
}

Sprite* Resources::sprite(const std::string& label) const {
  for (const auto& p_sprite : m_sprites) {
    if (p_sprite->getLabel() == label) return p_sprite.get();
  }
  return nullptr;
}

std::string Resources::spriteLabels() const {
  std::vector<std::string> labels;
  for (const auto& p_sprite : m_sprites) labels.push_back(p_sprite->getLabel());
  return loadedAre(labels);
}

// Games of the published engine ask for null pointers.
bool Resources::standsIn(const char* call, const std::string& label, const std::string& loaded) {
  if (!m_world.compat()) m_world.logOnce(nothingLoaded(call, label, loaded));
  return !m_world.compat();
}

// Games ask for a sprite to see whether it is still to be loaded, so null is no fault there. If one follows
// it, the report of the crash has the line.
Sprite* Resources::spriteOrStandIn(const std::string& label) {
  Sprite* p_sprite = sprite(label);
  if (p_sprite != nullptr || m_world.compat()) return p_sprite;
  if (m_failed_sprites.contains(label)) return &missingSprite();
  m_world.noteOnce(nothingLoaded("getSprite", label, spriteLabels()));
  return nullptr;
}

Sprite& Resources::missingSprite() {
  if (m_missing_sprite == nullptr) {
    m_missing_sprite = std::make_unique<Sprite>(1);
    m_missing_sprite->setLabel("missing");
    m_missing_sprite->setWidth(1);
    m_missing_sprite->setHeight(1);
    m_missing_sprite->addFrame(Frame(1, 1, "?"));
  }
  return *m_missing_sprite;
}

int Resources::loadSound(const std::string& filename, const std::string& label) {
  if (sound(label) != nullptr) return 0;
  Sound loaded;
  loaded.setLabel(label);
  if (loaded.loadSound(filename) != 0) return -1;
  m_sounds.push_back(loaded);
  return 0;
}

int Resources::unloadSound(const std::string& label) {
  const auto it = findSound(m_sounds, label);
  if (it == m_sounds.end()) return -1;
  it->endLoop();
  m_sounds.erase(it);
  return 0;
}

Sound* Resources::sound(const std::string& label) {
  const auto it = findSound(m_sounds, label);
  return it == m_sounds.end() ? nullptr : &*it;
}

Sound* Resources::soundOrStandIn(const std::string& label) {
  if (Sound* p_sound = sound(label)) return p_sound;
  if (!standsIn("getSound", label, labelsOf(m_sounds))) return nullptr;
  if (m_missing_sound == nullptr) {
    m_missing_sound = std::make_unique<Sound>();
    m_missing_sound->silence();
  }
  return m_missing_sound.get();
}

int Resources::loadMusic(const std::string& filename, const std::string& label) {
  if (music(label) != nullptr) return 0;
  Music& loaded = m_musics.emplace_back();
  loaded.setLabel(label);
  if (loaded.loadMusic(filename) == 0) return 0;
  m_musics.pop_back();
  return -1;
}

int Resources::unloadMusic(const std::string& label) {
  const auto it = findSound(m_musics, label);
  if (it == m_musics.end()) return -1;
  it->endLoop();
  m_musics.erase(it);
  return 0;
}

Music* Resources::music(const std::string& label) {
  const auto it = findSound(m_musics, label);
  return it == m_musics.end() ? nullptr : &*it;
}

Music* Resources::musicOrStandIn(const std::string& label) {
  if (Music* p_music = music(label)) return p_music;
  if (!standsIn("getMusic", label, labelsOf(m_musics))) return nullptr;
  if (m_missing_music == nullptr) {
    m_missing_music = std::make_unique<Music>();
    m_missing_music->silence();
  }
  return m_missing_music.get();
}

}  // namespace df
