// The part of Object that shows something of itself: sprite and shape.

#include <utility>

#include "engine/collision/Mask.h"
#include "engine/sprites/AnimationLook.h"
#include "engine/world/ClassName.h"
#include "engine/world/Geometry.h"
#include "engine/world/Object.h"
#include "engine/world/ObjectExtras.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"
#include "engine/world/WorldStore.h"

namespace df {

ObjectExtras& Object::extras() {
  if (m_p_extras == nullptr) m_p_extras = std::make_unique<ObjectExtras>();
  return *m_p_extras;
}

void Object::hearWhilePaused() {
  extras().hears_while_paused = true;
}

// The world's lists must not go on with it.
void Object::dropExtras() {
  World* p_world = getWorld();
  if (p_world == nullptr) return;
  if (m_p_extras->animated != ObjectExtras::kNowhere) p_world->extras().animations.remove(*this);
  if (m_p_extras->follows_path) p_world->extras().walkers.remove(*this);
}

// The sprite or the shape is another one.
void Object::animate() {
  Sprite* p_sprite = m_p_extras->animation.getSprite();
  m_p_store->set(m_slot, WorldStore::kPainted, p_sprite != nullptr || m_p_extras->shape.has_value());
  World* p_world = getWorld();
  if (p_world == nullptr) return;
  if (p_sprite != nullptr && p_world->compat()) p_sprite->setNeverStill();  // one that the game has made
  p_world->forgetLook(m_slot);
  if (p_sprite != nullptr && p_sprite->getFrameCount() > 1) {
    p_world->extras().animations.add(*this);
  } else if (m_p_extras->animated != ObjectExtras::kNowhere) {
    p_world->extras().animations.remove(*this);
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
  p_world->logOnce("setSprite(\"" + sprite_label + "\") of " + nameOf(*this) +
                   ": no sprite is loaded under this label" + resources.spriteLabels());
  // So that there is something to see, and getAnimation().getSprite() is no null pointer.
  if (getSprite() == nullptr && !p_world->compat()) {
    Animation animation;
    animation.setSprite(&resources.missingSprite());
    Object::setAnimation(std::move(animation), false);  // a game's own is for what it has asked for
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

// The box of a single character around the position begins half a cell before it.
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
  if (World* p_world = getWorld()) p_world->forgetLook(m_slot);
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
  if (World* p_world = getWorld()) p_world->forgetLook(m_slot);
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
  const Vector at = on_view ? viewToWorld(getPosition()) : getPosition();
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

// Null if nothing goes on by itself. What draw() really draws decides whether it counts.
std::shared_ptr<const naiad::Look> Object::publishedLook(std::uint32_t tick) {
  if (m_p_store->has(m_slot, WorldStore::kFrames)) return m_p_store->frames(m_slot);
  if (m_p_extras == nullptr || m_p_extras->shape || !m_p_extras->is_centered) return nullptr;
  return m_p_extras->p_look = lookOf(m_p_extras->animation, tick, m_p_extras->p_look);
}

// In a box that is not the sprite's own, its characters would lie elsewhere than they are drawn.
const Mask* Object::spriteMask() const {
  const Sprite* p_sprite = getSprite();
  const bool as_drawn = p_sprite != nullptr && isCentered() && getBox() == p_sprite->getBox() &&
                        m_p_extras->animation.getTransform() == Transform::NO_TRANSFORM;
  if (!as_drawn) return nullptr;
  return p_sprite->mask(m_p_extras->animation.getIndex());
}

}  // namespace df
