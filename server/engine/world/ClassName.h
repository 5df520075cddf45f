// The name of a class as its author wrote it.
#pragma once

#include <string>
#include <typeinfo>

namespace df {

/// Returns a class's name, such as "Saucer" or "game::Saucer", without anonymous namespaces.
std::string classNameOf(const std::type_info& type);

/// Returns `type`, or the name of the class if setType() was not called.
std::string nameOf(const std::string& type, const std::type_info& dynamic);
/// Returns the type, or else the class name, of an Object. Do not call it in constructors, where an Object is
/// not yet of its class.
template <class T>
std::string nameOf(const T& object) {
  return nameOf(object.getType(), typeid(object));
}

}  // namespace df
