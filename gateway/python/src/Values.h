// Values of Python as samples, and samples as values.
#pragma once

#include <rabit/RabitMessage.h>
#include <rabit/dynamic/CdrBuilder.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "Codec.h"

// All functions need the GIL.
namespace Rabit::Python
{

// The value of a sample in normal form. Arrays of numbers are views of one copy of the sample.
py::object Decode(const Codec &codec, std::span<const std::uint8_t> sample);
// The same of a message.
py::object ValueOf(const MessageClass &type, const RabitMessage &message);
// A sample of any form; throws py::value_error if it is none of that type.
py::object ValueOfBytes(const MessageClass &type, std::span<const std::uint8_t> bytes);

// The sample of a value. Throws py::type_error or py::value_error: `Uav::Goto.altitude_m: expected a number,
// not 'high'`. `path` is the beginning of that, if it is not the name of the type.
std::vector<std::uint8_t> Encode(const Codec &codec, py::handle value);
std::vector<std::uint8_t> Encode(const Codec &codec, py::handle value, const std::string &path);
// The sample of a member that is not given.
std::vector<std::uint8_t> EncodeDefault(const Codec::Field &field);
// A message with the contents of a value, of the class that its type has in this process.
std::shared_ptr<RabitMessage> MessageOf(const MessageClass &type, py::handle value);
// Makes a message one of that sample.
void Assign(const MessageClass &type, std::span<const std::uint8_t> sample, RabitMessage &message);

// Sets the members of a new value: those that are given, in order or by name, and the defaults.
void Init(py::handle self, const py::tuple &given, const py::dict &named);
// Sets a member to a value, which it converts to the member's type.
void SetMember(py::handle self, py::handle name, py::handle value);

}  // namespace Rabit::Python
