// The name of a class as its author wrote it.
#pragma once

#include <string>
#include <typeinfo>

namespace df {

/// "Saucer", "game::Saucer"; anonymous namespaces are left out.
std::string classNameOf(const std::type_info& type);

/// `type`, or where setType() was forgotten the name of the class.
std::string nameOf(const std::string& type, const std::type_info& dynamic);
/// The name of an Object. Not in constructors, where an Object is not yet of its class.
template <class T>
std::string nameOf(const T& object) {
  return nameOf(object.getType(), typeid(object));
}

}  // namespace df
