#pragma once

#include <rabit/RabitMessage.h>

#include <string>
#include <vector>

namespace Rabit
{
class MessageType;

// The message types of this process, by IDL name, so that a configuration file can name them. Generated code
// adds its types before main() runs; a program may add types that it learned of at run time
// (DynamicType::Register). All functions may be called from any thread.
class MessageTypeRegistry
{
public:
    // Adds a type; it must live until the process ends. A second type with the same name and IDL is ignored
    // (two libraries with one IDL file); one with different IDL throws std::logic_error.
    static void Add(const MessageType &type);
    // The type of that IDL name, or null.
    static const MessageType *Find(const std::string &name);
    // The type of a message (its dynamic type), or null if it has none. It lives at least as long as the
    // message.
    static const MessageType *Of(const RabitMessage &message);
    // All names, sorted.
    static std::vector<std::string> Names();
};

}  // namespace Rabit
