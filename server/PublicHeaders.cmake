# All installed headers: those that games include, and in detail/ the headers that they need. A test compiles each of them
# alone against the installed tree. For each public header the build generates a short wrapper with the header's name. It
# undefines the game's one-letter macros (detail/MacrosPush.h), includes the header itself from text/, and restores the
# macros.
set(naiad_public_headers
  server/engine/effects/Debris.h
  server/engine/effects/Fader.h
  server/engine/effects/Firework.h
  server/engine/effects/Particle.h
  server/engine/effects/Precipitation.h
  server/engine/events/Event.h
  server/engine/events/EventKeyboard.h
  server/engine/events/EventMouse.h
  server/engine/events/EventOut.h
  server/engine/events/EventStep.h
  server/engine/events/EventType.h
  server/engine/events/EventView.h
  server/engine/managers/Clock.h
  server/engine/managers/Config.h
  server/engine/managers/DisplayManager.h
  server/engine/managers/GameManager.h
  server/engine/managers/InputManager.h
  server/engine/managers/Manager.h
  server/engine/managers/ResourceManager.h
  server/engine/managers/SceneGraph.h
  server/engine/managers/WorldManager.h
  server/engine/prelude/Microsoft.h
  server/engine/prelude/Sfml.h
  server/engine/prelude/StandardHeaders.h
  server/engine/published/EventNetwork.h
  server/engine/published/GraphicsManager.h
  server/engine/published/LogManager.h
  server/engine/published/NetworkManager.h
  server/engine/published/NetworkNode.h
  server/engine/published/PathManager.h
  server/engine/published/Position.h
  server/engine/published/QuadtreeNode.h
  server/engine/published/Splash.h
  server/engine/published/SplashDragonfly.h
  server/engine/published/State.h
  server/engine/published/StateMachine.h
  server/engine/published/Windows.h
  server/engine/published/conio.h
  server/engine/published/direct.h
  server/engine/published/utility.h
  server/engine/published/vector.h
  server/engine/published/windows.h
  server/engine/sprites/Animation.h
  server/engine/sprites/Frame.h
  server/engine/sprites/Sprite.h
  server/engine/testing/GameTest.h
  server/engine/widgets/Button.h
  server/engine/widgets/Fraps.h
  server/engine/widgets/Pause.h
  server/engine/widgets/PlayerObject.h
  server/engine/widgets/TextBox.h
  server/engine/widgets/TextEntry.h
  server/engine/widgets/ViewObject.h
  server/engine/world/Circle.h
  server/engine/world/Contact.h
  server/engine/world/Controls.h
  server/engine/world/EventCollision.h
  server/engine/world/EventPath.h
  server/engine/world/EventPlayer.h
  server/engine/world/GameRooms.h
  server/engine/world/HighScores.h
  server/engine/world/Layer.h
  server/engine/world/Line.h
  server/engine/world/Music.h
  server/engine/world/Object.h
  server/engine/world/ObjectAttributes.h
  server/engine/world/ObjectList.h
  server/engine/world/ObjectListIterator.h
  server/engine/world/Path.h
  server/engine/world/PathFind.h
  server/engine/world/Player.h
  server/engine/world/Random.h
  server/engine/world/Ref.h
  server/engine/world/Runner.h
  server/engine/world/Shape.h
  server/engine/world/Sound.h
  server/engine/world/World.h
  shared/math/Elementary.h
  shared/values/Box.h
  shared/values/Canvas.h
  shared/values/Color.h
  shared/values/ControlTable.h
  shared/values/Fixed.h
  shared/values/Keyboard.h
  shared/values/Solidness.h
  shared/values/Vector.h
  shared/values/Version.h)
# The physics headers. Compilers search their folder last, because games may have headers with the names of these, like
# Field.h.
set(naiad_physics_headers
  server/physics/body/Body.h
  server/physics/body/BodyDrawing.h
  server/physics/body/BodyJoint.h
  server/physics/body/EventContactEnd.h
  server/physics/body/Field.h
  server/physics/body/PhysicsManager.h
  server/physics/body/Seconds.h
  server/physics/body/SoftObject.h
  server/physics/geometry/ConvexShape.h
  server/physics/geometry/Rotation.h
  server/physics/geometry/Vec2.h
  server/physics/kits/Bridge.h
  server/physics/kits/Grip.h
  server/physics/kits/Obstacle.h
  server/physics/kits/Ragdoll.h
  server/physics/numerics/Integrator.h)
set(naiad_detail_headers
  server/engine/collision/Mask.h
  server/engine/collision/ObjectKey.h
  server/engine/collision/MoverStats.h
  server/engine/effects/Particles.h
  server/engine/events/KeyCharacter.h
  server/engine/managers/LogManager.h
  server/engine/prelude/SfmlDrawing.h
  server/engine/prelude/SfmlInput.h
  server/engine/prelude/SfmlValues.h
  server/engine/published/EventNetworks.h
  server/engine/world/ColorMix.h
  server/engine/world/GameRoom.h
  server/engine/world/Geometry.h
  server/engine/world/HighScore.h
  server/engine/world/LagCompensation.h
  server/engine/world/ObjectProfile.h
  server/engine/world/Settings.h
  server/engine/world/WorldScope.h
  server/engine/world/WorldState.h
  server/engine/world/WorldView.h
  shared/values/LanguageStandard.h)

# Headers generated in detail/, which undefine and restore one-letter macros.
set(naiad_macro_headers
  MacrosPush.h MacrosPop.h)
# Generated headers, each of which includes detail/EventNetworks.h.
set(naiad_event_network_headers
  EventCustomNetwork.h EventKeyboardNetwork.h EventMouseNetwork.h EventNetworkAccept.h EventNetworkClose.h EventNetworkConnect.h
  EventNetworkCreate.h EventNetworkCustom.h EventNetworkDelete.h EventNetworkGameOver.h EventNetworkSync.h)
# Headers generated in SFML/, each of which includes Sfml.h.
set(naiad_sfml_headers
  Audio.hpp Graphics.hpp System.hpp Window.hpp
  Audio/Music.hpp Audio/Sound.hpp Audio/SoundBuffer.hpp Audio/SoundSource.hpp
  Graphics/CircleShape.hpp Graphics/Color.hpp Graphics/ConvexShape.hpp Graphics/Drawable.hpp Graphics/Font.hpp
  Graphics/Image.hpp Graphics/PrimitiveType.hpp Graphics/Rect.hpp Graphics/RectangleShape.hpp
  Graphics/RenderWindow.hpp Graphics/Shape.hpp Graphics/Sprite.hpp Graphics/Text.hpp Graphics/Texture.hpp
  Graphics/Transformable.hpp Graphics/Vertex.hpp Graphics/VertexArray.hpp
  System/Clock.hpp System/Time.hpp System/Vector2.hpp
  Window/Keyboard.hpp Window/Mouse.hpp)
