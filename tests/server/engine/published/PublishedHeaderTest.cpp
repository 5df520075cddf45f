// A game header that includes only "Manager.h" and "LogManager.h": the other names must come from indirect
// includes. Also, a game's own class names must not collide with the engine's.

#include "Manager.h"

df::ObjectListIterator overObjectsOf(df::ObjectList& list) {
  for (df::ObjectListIterator li(&list); !li.isDone(); li.next()) li.currentObject()->setPosition({1, 2});
  df::ObjectListIterator li = df::ObjectListIterator(&list);
  li.last();
  return li;
}

bool isWayFound(const df::Event* p_e) {
  return dynamic_cast<const df::EventPath*>(p_e) != nullptr && p_e->getType() == df::PATH_EVENT;
}

#include "LogManager.h"

float nearTo(const df::Object* p_o) {
  df::addParticles(df::SPARKS, p_o->getPosition(), 1, df::RED);
  std::queue<int> waiting;
  std::set<int> ids;
  std::array<int, 2> pair{};
  return df::distance(p_o->getPosition(), df::Vector(float(pair[0]), float(waiting.size() + ids.size())));
}

#include "DisplayManager.h"
#include "EventStep.h"
#include "GameManager.h"
#include "InputManager.h"
#include "ResourceManager.h"
#include "WorldManager.h"

using namespace df;

// Class names that no header included above defines.
class Button : public Object {};
class Clock : public Object {};
class Entry : public Object {};
class EventNetwork : public Event {};
class Fader : public Object {};
enum class MessageType { UNDEFINED = -1, EXIT, CHAT };
class NetworkManager : public Manager {};
class Pause : public Object {};
class Settings : public Object {};
class State : public Object {};
class TextBox : public Object {};

int namesOfAGame() {
  Button button;
  Clock clock;
  Entry entry;
  EventNetwork event_network;
  Fader fader;
  NetworkManager network_manager;
  Pause pause;
  Settings settings;
  State state;
  TextBox text_box;
  return button.getId() + clock.getId() + entry.getId() + fader.getId() + pause.getId() + settings.getId() +
         state.getId() + text_box.getId() + static_cast<int>(MessageType::CHAT) +
         static_cast<int>(event_network.getType().size()) + network_manager.onEvent(&event_network);
}

int stepsOfTheEngineSpelledTwice() {
  return df::GM.getStepCount() + df::WM.getAllObjects().getCount();
}

// Calls Microsoft's string functions.
std::string ping(int count) {
  char line[12];
  sprintf_s(line, "Ping %d", count);
  char copy[8];
  strcpy_s(copy, line);
  strcat_s(copy, sizeof copy, "!");
  sprintf_s(line, sizeof line, "%s", copy);
  return line;
}

// Makes SFML calls that bypass the engine, without including a header of the graphics library.
void pastTheEngine() {
  const sf::Vector2f from(spacesToPixels(Vector(1, 2)).getX(), 3);
  const sf::Vertex line[]{{{from}, sf::Color::Red}, {{from + sf::Vector2f(1, 1)}, colorToSFML(df::GREEN)}};
  DM.getWindow()->draw(line, 2, sf::PrimitiveType::Lines);
  sf::CircleShape circle(80);
  circle.setFillColor(sf::Color(237, 247, 84, 100));
  circle.setPosition(from.x - 75, from.y);
  DM.getWindow()->draw(circle);
  if (sf::Mouse::isButtonPressed(sf::Mouse::Button::Left) || sf::Keyboard::isKeyPressed(sf::Keyboard::Space))
    circle.move(sf::Mouse::getPosition(*DM.getWindow()).x * 1.0f, 0);
}

// Logs arguments that printf() does not accept.
int logStrings(const Object& o) {
  const std::string name = "ann";
  LM.writeLog("%s has %d of %s", name, 3, o.getType());
  LM.writeLog(0, "%s", name);
  return LM.writeLog("%d", 5);
}
