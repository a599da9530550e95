#pragma once

#include <rabit/RabitMessage.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <typeindex>

namespace Rabit
{

// Run-time description of one IDL type. Creates its messages, and converts them to bytes and back.
//
// The bytes are those of a DDS sample of the type: a 4-byte encapsulation header (CDR, in the byte order
// that it names; we write little endian), then plain XCDR1 (OMG DDS-XTypes 1.3, 7.4.1), with no header of
// Rabit's own. Zeros fill it up to a multiple of 4 bytes. The last two bits of the header give the number of
// these zeros (XTypes 1.3, 7.6.3.1.2). Equal messages give equal bytes. One object exists for each generated
// message class and lives as long as the process; DynamicType is for types made at run time. All are
// immutable and may be used from any thread.
class MessageType
{
public:
    virtual ~MessageType() = default;
    MessageType(const MessageType &) = delete;
    MessageType &operator=(const MessageType &) = delete;

    // The IDL name with its modules, for instance `Uav::Pose`. It is also the DDS type name.
    virtual const std::string &Name() const = 0;
    // The IDL that this type was generated from, the types it uses included: it compiles by itself.
    virtual const std::string &IdlText() const = 0;
    // The hash by which ROS 2 names the definition of the type (REP-2011), as `RIHS01_df668c74...`; empty if
    // ROS 2 cannot have the type.
    virtual const std::string &RosTypeHash() const
    {
        static const std::string none;
        return none;
    }
    // A message of this type with default values, of the class CppType.
    virtual std::unique_ptr<RabitMessage> Create() const = 0;
    // The same, shared from the start: one allocation instead of two.
    virtual std::shared_ptr<RabitMessage> CreateShared() const = 0;
    // The C++ class of its messages; messages of several types may share one (SelfDescribing).
    virtual std::type_index CppType() const = 0;
    // True if this is the type of that message (its dynamic type, not a base of it).
    virtual bool IsTypeOf(const RabitMessage &message) const = 0;

    // Bytes that Serialize will write for this message, the header included. Throws std::invalid_argument if
    // the message is of another type.
    virtual std::size_t SerializedSize(const RabitMessage &message) const = 0;
    // Writes the message. Returns the bytes written; 0 if the buffer is too small or the message cannot be
    // expressed in IDL. Such a message has a string or sequence beyond its bound, a zero byte in a string, or
    // an undeclared enum or bitmask value. Throws as SerializedSize.
    virtual std::size_t Serialize(const RabitMessage &message, std::span<std::uint8_t> buffer) const = 0;
    // Reads a message from borrowed bytes of either byte order. Returns false if they are not a sample of
    // this type: truncated, more than 3 bytes too long, out of bounds, an unknown encoding, or an impossible
    // value; the message then has valid but unspecified contents. No bytes make it throw or read past their
    // end. It allocates at most 64 KiB plus 256 bytes for each of the bytes, and refuses a message that would
    // take more: one with very many values that are small on the wire and large in memory (idl/README.md).
    // The message's time stamp, its three ints and its global reference stay unchanged. Throws as
    // SerializedSize.
    virtual bool Deserialize(std::span<const std::uint8_t> bytes, RabitMessage &message) const = 0;

    // True if the type, or a base of it, has @key members.
    virtual bool HasKey() const = 0;
    // The key hash of OMG DDSI-RTPS 2.3, 9.6.3.8, of a serialized sample. False if Deserialize would refuse
    // the bytes, or the type has no key. Stores nothing of the sample and allocates nothing.
    virtual bool KeyHashOf(std::span<const std::uint8_t> bytes, std::array<std::uint8_t, 16> &hash) const = 0;

protected:
    MessageType() = default;
};

}  // namespace Rabit
