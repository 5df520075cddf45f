// The part of Object for looks, paths, and attributes as text.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <sstream>
#include <utility>

#include "engine/collision/Mask.h"
#include "engine/sprites/Animation.h"
#include "engine/sprites/Sprite.h"
#include "engine/world/ClassName.h"
#include "engine/world/ConfigText.h"
#include "engine/world/Object.h"
#include "engine/world/ObjectExtras.h"
#include "engine/world/ObjectLookAccess.h"
#include "engine/world/PathFind.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"
#include "engine/world/WorldLog.h"
#include "engine/world/WorldStore.h"
#include "shared/replica/Limits.h"
#include "shared/replica/Look.h"
#include "shared/replica/LookCodec.h"

namespace df {

/// Friend of Sprite that returns all its frames in the form for clients. Returns none if there are no frames,
/// too many (kMaxFrames), too large ones, or if they draw nothing.
class SpritePictures {
 public:
  static const naiad::Sequence& of(const Sprite& sprite) { return sprite.pictures(); }
};

namespace {

naiad::Selector selectorOf(const Animation& animation, std::uint32_t tick) {
  const int slowdown = animation.getSprite()->getTicksPerFrame();
  const int count = animation.getSlowdownCount();
  const auto index = static_cast<std::size_t>(animation.getIndex());
  const bool still = slowdown < 1 || count < 0 || slowdown > int{naiad::kMaxTicksPerFrame};
  if (still) return naiad::Selector::fixed(index);
  // A count above the slowdown shows the next frame in the next tick, as does the count slowdown - 1.
  const auto shown = static_cast<std::uint32_t>(std::min(count, slowdown - 1));
  return naiad::Selector::clock(tick - shown, static_cast<std::uint32_t>(slowdown), true, index);
}

// Clients get an animation as the pictures of its sprite, and a clock that selects the picture to show. While
// only the clock decides, clients draw the animation without further messages.

/// Returns a look that shows `animation` from `tick` on, until the animation is stopped, set or hidden. Null
/// if there are no pictures for clients, or only one, if the animation is mirrored, or if its index is not
/// that of a frame. Returns `before`, an earlier result, if that is still correct.
std::shared_ptr<const naiad::Look> lookOf(const Animation& animation, std::uint32_t tick,
                                          const std::shared_ptr<const naiad::Look>& before) {
  const Sprite* p_sprite = animation.getSprite();
  if (p_sprite == nullptr || p_sprite->getFrameCount() < 2) return nullptr;
  if (animation.getTransform() != Transform::NO_TRANSFORM) return nullptr;  // its pictures are mirrored
  if (animation.getIndex() < 0 || animation.getIndex() >= p_sprite->getFrameCount()) return nullptr;
  const naiad::Sequence& pictures = SpritePictures::of(*p_sprite);
  if (pictures.empty()) return nullptr;
  const naiad::Selector selector = selectorOf(animation, tick).rebased(tick, pictures.size());
  if (before != nullptr && before->sequence.isSharedWith(pictures) &&
      before->selector.rebased(tick, pictures.size()) == selector)
    return before;
  return std::make_shared<const naiad::Look>(naiad::Look{pictures, 0, selector});
}

constexpr unsigned kAll = (1u << ObjectAttributeMax) - 1;
// Names of the attributes in serialize(), by the number of their bits.
constexpr const char* kNames[ObjectAttributeMax] = {
    "id",        "active",       "visible",  "events",    "box",         "pos",
    "type",      "animation",    "altitude", "solidness", "no_soft",     "speed",
    "direction", "acceleration", "shape",    "path",      "follow_path", "avoid_collisions"};

unsigned maskOf(const std::string& attr) {
  unsigned mask = 0;
  std::istringstream names(attr);
  for (std::string name; std::getline(names, name, ',');) {
    if (name == "ALL") mask = kAll;
    for (int i = 0; i < ObjectAttributeMax; ++i) {
      if (name == kNames[i]) mask |= 1u << i;
    }
  }
  return mask;
}

}  // namespace

ObjectExtras& Object::extras() {
  if (m_p_extras == nullptr) m_p_extras = std::make_unique<ObjectExtras>();
  return *m_p_extras;
}

void Object::receiveWhilePaused() {
  extras().receives_while_paused = true;
}

bool Object::receivesWhilePaused() const {
  return m_p_extras != nullptr && m_p_extras->receives_while_paused;
}

// Removes the Object from the world's lists of running animations and of Objects that walk.
void Object::dropExtras() {
  World* p_world = getWorld();
  if (p_world == nullptr) return;
  if (m_p_extras->animated != ObjectExtras::kNowhere) p_world->extras().animations.remove(*m_p_extras);
  if (m_p_extras->follows_path) p_world->setWalking(*this, false);
}

// Updates the store's flag and the world's list of running animations. Call after the sprite or the shape has
// changed.
void Object::animate() {
  Sprite* p_sprite = m_p_extras->animation.getSprite();
  m_p_store->set(m_slot, WorldStore::kPainted, p_sprite != nullptr || m_p_extras->shape.has_value());
  World* p_world = getWorld();
  if (p_world == nullptr) return;
  if (p_sprite != nullptr && p_world->compat()) p_sprite->setNeverStill();  // also a game's own sprite
  invalidateLook();
  if (p_sprite != nullptr && p_sprite->getFrameCount() > 1) {
    p_world->extras().animations.add(m_slot, *m_p_extras);
  } else if (m_p_extras->animated != ObjectExtras::kNowhere) {
    p_world->extras().animations.remove(*m_p_extras);
  }
}

int Object::setSprite(std::string sprite_label) {
  return setSprite(sprite_label, true);
}

int Object::setSprite(const std::string& sprite_label, bool set_box) {
  World* p_world = getWorld();
  if (p_world == nullptr) return -1;
  Resources& resources = p_world->extras().resources;
  if (Sprite* p_sprite = resources.sprite(sprite_label)) return setSprite(p_sprite, set_box);
  p_world->log().writeOnce("setSprite(\"" + sprite_label + "\") of " + nameOf(*this) +
                           ": no sprite is loaded under this label" + resources.spriteLabels());
  // Shows a placeholder, so that something is visible and getAnimation().getSprite() is not null.
  if (getSprite() == nullptr && !p_world->compat()) {
    Animation animation;
    animation.setSprite(&resources.missingSprite());
    Object::setAnimation(std::move(animation), false);  // not an override, which expects the game's sprite
  }
  return -1;
}

int Object::setSprite(Sprite* p_new_sprite, bool set_box) {
  Animation animation;
  animation.setSprite(p_new_sprite);
  if (p_new_sprite != nullptr) animation.setName(p_new_sprite->getLabel());
  setAnimation(animation, set_box);
  return 0;
}

int Object::setAnimation(Animation new_animation, bool set_box) {
  const bool fits = set_box && new_animation.getSprite() != nullptr;
  extras().animation = std::move(new_animation);
  if (fits) fitBox();
  animate();
  return 0;
}

// Sets the box to the sprite's. If the sprite is not centred, the middle of its first character is at the
// position, so the box's corner is (-0.5,-0.5).
void Object::fitBox() {
  Box box = m_p_extras->animation.getBox();
  if (!m_p_extras->is_centered) box.setCorner(Vector(-0.5, -0.5));
  setBox(box);
}

void Object::setCentered(bool centered) {
  extras().is_centered = centered;
  if (getSprite() != nullptr) fitBox();
  animate();
}

bool Object::isCentered() const {
  return m_p_extras == nullptr || m_p_extras->is_centered;
}

void Object::setSpriteName(std::string new_name) {
  extras().animation.setName(std::move(new_name));
}

Animation Object::getAnimation() const {
  return m_p_extras != nullptr ? m_p_extras->animation : Animation();
}

void Object::setSpriteIndex(int new_index) {
  extras().animation.setIndex(new_index);
  invalidateLook();
}

void Object::setSpriteSlowdown(int new_slowdown) {
  if (Sprite* p_sprite = getSprite()) p_sprite->setSlowdown(new_slowdown);
}

int Object::getSpriteSlowdown() const {
  const Sprite* p_sprite = getSprite();
  return p_sprite != nullptr ? p_sprite->getSlowdown() : 0;
}

void Object::setSpriteSlowdownCount(int new_slowdown_count) {
  extras().animation.setSlowdownCount(new_slowdown_count);
}

void Object::setTransparency(char new_transparency) {
  if (Sprite* p_sprite = getSprite()) p_sprite->setTransparency(new_transparency);
  invalidateLook();
}

char Object::getTransparency() const {
  const Sprite* p_sprite = getSprite();
  return p_sprite != nullptr ? p_sprite->getTransparency() : '\0';
}

void Object::showOnView() {
  m_p_store->set(m_slot, WorldStore::kOnView, true);
}

void Object::setShape(Shape new_shape) {
  extras().shape = new_shape;
  animate();
}

Shape Object::getShape() const {
  return m_p_extras != nullptr && m_p_extras->shape ? *m_p_extras->shape : Shape();
}

int Object::draw() {
  World* p_world = getWorld();
  if (p_world != nullptr && m_p_store->has(m_slot, WorldStore::kFrames)) p_world->drawFrame(m_slot);
  if (m_p_extras == nullptr) return 0;
  const bool on_view = m_p_store->has(m_slot, WorldStore::kOnView);
  const Vector at = on_view ? getPosition() + World::current().getView().getCorner() : getPosition();
  int result = 0;
  if (const Sprite* p_sprite = m_p_extras->animation.getSprite()) {
    const Box box = p_sprite->getBox();
    const Vector to_middle =
        m_p_extras->is_centered ? Vector() : Vector((box.width() - 1) / 2, (box.height() - 1) / 2);
    result = m_p_extras->animation.paint(at + to_middle);
  }
  if (m_p_extras->shape) m_p_extras->shape->draw(at);
  return result;
}

// Returns the look with which clients draw the Object's frames or animation themselves; null for none. It is
// used only if draw() draws the characters that the look shows.
std::shared_ptr<const naiad::Look> Object::publishedLook(std::uint32_t tick) {
  if (m_p_store->has(m_slot, WorldStore::kFrames)) return m_p_store->frames(m_slot);
  if (m_p_extras == nullptr || m_p_extras->shape || !m_p_extras->is_centered) return nullptr;
  return m_p_extras->p_look = lookOf(m_p_extras->animation, tick, m_p_extras->p_look);
}

// Returns null unless a sprite is drawn untransformed and centred in its own box, because otherwise the mask
// would not lie where the characters are drawn.
const Mask* spriteMaskOf(const Object& object) {
  const Sprite* p_sprite = object.getSprite();
  const bool as_drawn = p_sprite != nullptr && object.isCentered() && object.getBox() == p_sprite->getBox() &&
                        object.m_p_extras->animation.getTransform() == Transform::NO_TRANSFORM;
  if (!as_drawn) return nullptr;
  return p_sprite->mask(object.m_p_extras->animation.getIndex());
}

// Makes a static look be drawn again.
void Object::invalidateLook() {
  if (getWorld() != nullptr) m_p_store->set(m_slot, WorldStore::kLookCached, false);
}

void Object::setStaticLook(bool static_look) {
  m_p_store->set(m_slot, WorldStore::kStaticLook, static_look);
  invalidateLook();
}

bool Object::hasStaticLook() const {
  return m_p_store->has(m_slot, WorldStore::kStaticLook);
}

int ObjectLookAccess::setFrames(Object& object, const naiad::Sequence& frames,
                                const naiad::Selector& selector) {
  WorldStore& store = *object.m_p_store;
  if (frames.empty()) {
    store.setFrames(object.m_slot, nullptr);
    return 0;
  }
  const bool small = frames.size() <= naiad::kMaxFrames && frames.glyphCount() <= naiad::kMaxGlyphs &&
                     frames.reach() <= naiad::kMaxGlyphOffset;
  if (!small || !selector.fits(frames.size()) || naiad::encodedBits(frames) > 8 * naiad::kMaxLookBytes)
    return object.refuse("setFrames");
  store.setFrames(object.m_slot, std::make_shared<const naiad::Look>(naiad::Look{frames, 0, selector}));
  return 0;
}

int ObjectLookAccess::setSelector(Object& object, const naiad::Selector& selector) {
  WorldStore& store = *object.m_p_store;
  const std::shared_ptr<const naiad::Look>& p_look = store.frames(object.m_slot);
  if (p_look == nullptr || !selector.fits(p_look->sequence.size())) return object.refuse("setSelector");
  if (p_look->selector == selector) return 0;
  store.setFrames(object.m_slot,
                  std::make_shared<const naiad::Look>(naiad::Look{p_look->sequence, 0, selector}));
  return 0;
}

int Object::getFrameCount() const {
  const std::shared_ptr<const naiad::Look>& p_look = m_p_store->frames(m_slot);
  return p_look != nullptr ? static_cast<int>(p_look->sequence.size()) : 0;
}

int Object::getFrame() const {
  const std::shared_ptr<const naiad::Look>& p_look = m_p_store->frames(m_slot);
  const World* p_world = getWorld();
  if (p_look == nullptr || p_world == nullptr) return 0;
  const auto tick = static_cast<std::uint32_t>(p_world->getStepCount());
  return static_cast<int>(p_look->selector.at(tick, p_look->sequence.size()));
}

// Paths.

void Object::pathTo(Vector position) {
  World* p_world = getWorld();
  if (p_world == nullptr) return;
  setAvoidCollisions();
  Path path = findPath(*this, position);
  EventPath event(path);
  if (path.getPath().empty()) event.setResult(NOT_FOUND);
  setFollowPath(false);
  setPath(std::move(path));
  if (event.getResult() == FOUND) setFollowPath();
  p_world->deliver(key(), event);  // last, because the handler may delete this Object
}

void Object::pathTo(const Object* p_o_target) {
  if (p_o_target != nullptr) pathTo(p_o_target->getPosition());
}

void Object::moveTo(Vector new_position) {
  Vector direction = new_position - getPosition();
  direction.normalize();
  setDirection(direction);
}

void Object::setPath(Path new_path) {
  extras().path = std::move(new_path);
}

Path Object::getPath() const {
  return m_p_extras != nullptr ? m_p_extras->path : Path();
}

void Object::setFollowPath(bool new_follow_path) {
  if (!new_follow_path && m_p_extras == nullptr) return;
  extras().follows_path = new_follow_path;
  if (!new_follow_path) m_p_extras->path_speed = 0;
  if (World* p_world = getWorld()) p_world->setWalking(*this, new_follow_path);
}

bool Object::getFollowPath() const {
  return m_p_extras != nullptr && m_p_extras->follows_path;
}

void Object::setAvoidCollisions(bool new_avoid_collisions) {
  extras().avoids_collisions = new_avoid_collisions;
}

bool Object::getAvoidCollisions() const {
  return m_p_extras != nullptr && m_p_extras->avoids_collisions;
}

// Text.

ObjectAttributes Object::attributes() const {
  const Box box = getBox();
  const Animation animation = getAnimation();
  const auto flag = [this](WorldStore::Flag f) { return m_p_store->has(m_slot, f) ? 1.0 : 0.0; };
  return {keyValue("id", getId()),
          keyValue("active", flag(WorldStore::kActive)),
          keyValue("visible", flag(WorldStore::kVisible)),
          keyValue("events", static_cast<double>(m_p_profile->interests.size())),
          keyValue("box", box.getCorner()) + keyValue("box-horizontal", box.width()) +
              keyValue("box-vertical", box.height()),
          keyValue("pos", getPosition()),
          keyValue("type", getType()),
          keyValue("animation", animation.getName()) + keyValue("animation-index", animation.getIndex()) +
              keyValue("animation-count", animation.getSlowdownCount()),
          keyValue("altitude", getAltitude()),
          keyValue("solidness", getSolidness()),
          keyValue("no_soft", flag(WorldStore::kNoSoft)),
          keyValue("velocity", getVelocity()),
          keyValue("direction", getDirection()),
          keyValue("acceleration", getAcceleration()),
          keyValue("shape", m_p_extras != nullptr && m_p_extras->shape ? 1 : 0),
          keyValue("path-nodes", static_cast<double>(getPath().getPath().size())),
          keyValue("follow_path", getFollowPath() ? 1 : 0),
          keyValue("avoid_collisions", getAvoidCollisions() ? 1 : 0)};
}

unsigned int Object::getModified() const {
  if (m_p_extras == nullptr || !m_p_extras->serialized) return kAll;
  const ObjectAttributes now = attributes();
  unsigned mask = m_p_extras->modified;
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (now[i] != (*m_p_extras->serialized)[i]) mask |= 1u << i;
  }
  return mask;
}

void Object::setModified(unsigned int new_modified) {
  extras().modified = new_modified & kAll;
}

bool Object::isModified(ObjectAttribute attribute) const {
  return (getModified() & static_cast<unsigned>(attribute)) != 0;
}

std::string Object::serialize(std::string attr) {
  std::stringstream out;
  const unsigned mask = attr.empty() ? getModified() : maskOf(attr);
  if (mask != 0) Object::serialize(&out, mask);
  return out.str();
}

int Object::serialize(std::stringstream* p_ss, unsigned int attr) {
  if (p_ss == nullptr) return -1;
  const unsigned mask = attr != 0 ? attr : getModified();
  const ObjectAttributes now = attributes();
  ObjectExtras& mine = extras();
  // Attributes that were never written still count as modified.
  if (!mine.serialized) mine.serialized.emplace();
  for (std::size_t i = 0; i < now.size(); ++i) {
    if ((mask >> i & 1) == 0) continue;
    *p_ss << now[i];
    (*mine.serialized)[i] = now[i];
  }
  mine.modified &= ~mask;
  return 0;
}

int Object::deserialize(std::string s) {
  std::stringstream in(s);
  return Object::deserialize(&in, nullptr);
}

int Object::deserialize(std::stringstream* p_ss, unsigned int* p_a) {
  if (p_ss == nullptr) return -1;
  const std::string text = p_ss->str();
  unsigned mask = 0;
  int result = 0;
  const auto recordApplied = [&](ObjectAttribute attribute, int outcome) {
    mask |= static_cast<unsigned>(attribute);
    if (outcome != 0) result = -1;
  };
  const auto parseNumber = [&](ObjectAttribute attribute, const char* key, auto apply) {
    if (const auto value = numberOf(text, key)) recordApplied(attribute, apply(*value));
  };
  const auto parseVector = [&](ObjectAttribute attribute, const char* key, auto apply) {
    if (const auto value = vectorOf(text, key)) recordApplied(attribute, apply(*value));
  };
  const auto toInt = [](double value) {
    return value >= -2e9 && value <= 2e9 ? static_cast<int>(value) : -1;
  };

  parseNumber(ObjectAttribute::ID, "id", [&](double v) { return setId(toInt(v)), 0; });
  parseNumber(ObjectAttribute::ACTIVE, "active", [&](double v) { return setActive(v != 0); });
  parseNumber(ObjectAttribute::VISIBLE, "visible", [&](double v) { return setVisible(v != 0); });
  parseNumber(ObjectAttribute::NO_SOFT, "no_soft", [&](double v) { return setNoSoft(v != 0), 0; });
  parseNumber(ObjectAttribute::ALTITUDE, "altitude", [&](double v) { return setAltitude(toInt(v)); });
  parseNumber(ObjectAttribute::SOLIDNESS, "solidness",
              [&](double v) { return setSolidness(static_cast<Solidness>(toInt(v) & 3)); });
  if (const std::string type = valueOf(text, "type"); !type.empty()) {
    setType(type);
    recordApplied(ObjectAttribute::TYPE, 0);
  }
  if (const std::string sprite = valueOf(text, "animation"); !sprite.empty()) {
    recordApplied(ObjectAttribute::ANIMATION, getAnimation().getName() == sprite ? 0 : setSprite(sprite));
    if (const auto index = numberOf(text, "animation-index")) setSpriteIndex(toInt(*index));
    if (const auto count = numberOf(text, "animation-count")) setSpriteSlowdownCount(toInt(*count));
  }
  parseVector(ObjectAttribute::BOX, "box", [&](Vector corner) {
    return setBox(Box(corner, numberOf(text, "box-horizontal").value_or(getBox().width()),
                      numberOf(text, "box-vertical").value_or(getBox().height())));
  });
  parseVector(ObjectAttribute::POSITION, "pos", [&](Vector v) { return setPosition(v); });
  parseVector(ObjectAttribute::SPEED, "velocity", [&](Vector v) { return setVelocity(v); });
  parseVector(ObjectAttribute::ACCELERATION, "acceleration", [&](Vector v) { return setAcceleration(v); });
  if (p_a != nullptr) *p_a |= mask;
  return result;
}

std::string Object::toString() const {
  return getType() + " " + std::to_string(getId()) + " at " + getPosition().toString();
}

}  // namespace df
