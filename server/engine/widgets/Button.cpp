#include "engine/widgets/Button.h"

#include <cmath>

#include "engine/world/Geometry.h"
#include "engine/world/World.h"

namespace df {

Button::Button() {
  Object::setType("Button");
  ViewObject::setDrawValue(false);
  if (World::current().compat()) ViewObject::setLocation(CENTER_CENTER);
  registerInterest(MSE_EVENT);
}

void Button::setDefaultColor(Color new_default_color) {
  m_default_color = new_default_color;
  setColor(new_default_color);
}

bool Button::mouseOverButton(const EventMouse* p_e) const {
  if (p_e == nullptr) return false;
  const double border = getBorder() ? 1 : 0;
  const double length = static_cast<double>(getViewString().size()) + 2 * border;  // blanks inside the border
  const Vector place = worldToView(p_e->getMousePosition()) - getPosition();
  const double left = -std::floor(length / 2) - border;
  return place.x() >= left - 0.5 && place.x() < left + length + 2 * border &&
         std::fabs(place.y()) <= border + 0.5;
}

int Button::eventHandler(const Event* p_e) {
  const auto* p_mouse = dynamic_cast<const EventMouse*>(p_e);
  if (p_mouse == nullptr) return ViewObject::eventHandler(p_e);
  const bool over = mouseOverButton(p_mouse);
  setColor(over ? m_highlight_color : m_default_color);
  if (!over || p_mouse->getMouseAction() != CLICKED) return 0;
  callback();
  return 1;
}

}  // namespace df
