#pragma once

#include <rabit/idl/MessageType.h>
#include <rabit/idl/Shapes.h>

#include <fastcdr/exceptions/Exception.h>

#include <algorithm>
#include <limits>
#include <new>
#include <stdexcept>
#include <utility>

namespace Rabit::Idl
{

// Bytes before the body of a sample: two that name the encoding, two of options.
inline constexpr std::size_t EncapsulationSize = 4;

// Size of a sample with a body of `bodySize` bytes: header, body and padding.
constexpr std::size_t SampleSize(std::size_t bodySize)
{
    return EncapsulationSize + (bodySize + 3) / 4 * 4;
}

// Splits a sample into its body and byte order. False if it is not plain XCDR1.
bool OpenSample(std::span<const std::uint8_t> bytes, std::span<const std::uint8_t> &body, bool &littleEndian);
// Writes the encapsulation header of little-endian plain XCDR1 whose body is followed by padding bytes.
void WriteEncapsulation(std::span<std::uint8_t> sample, std::size_t padding);
// Bytes that may follow the body: padding to a multiple of 4.
inline constexpr std::size_t MaxPadding = 3;

// The MessageType of one generated message class, on top of its Codec. Generated code makes one object of
// each.
template <class Message>
class GeneratedMessageType final : public MessageType
{
public:
    GeneratedMessageType(std::string name, std::string idlText, std::string rosTypeHash = "")
        : _name(std::move(name)), _idlText(std::move(idlText)), _rosTypeHash(std::move(rosTypeHash))
    {
    }

    const std::string &Name() const override { return _name; }
    const std::string &IdlText() const override { return _idlText; }
    const std::string &RosTypeHash() const override { return _rosTypeHash; }
    std::unique_ptr<RabitMessage> Create() const override { return std::make_unique<Message>(); }
    std::shared_ptr<RabitMessage> CreateShared() const override { return std::make_shared<Message>(); }
    std::type_index CppType() const override { return typeid(Message); }
    bool IsTypeOf(const RabitMessage &message) const override { return typeid(message) == typeid(Message); }

    std::size_t SerializedSize(const RabitMessage &message) const override
    {
        const Message &concrete = Concrete(message);
        if constexpr (Codec<Message>::FixedSize != 0)
        {
            return SampleSize(Codec<Message>::FixedSize);
        }
        else
        {
            CdrSizer sizer;
            Codec<Message>::Size(sizer, concrete);
            return SampleSize(sizer.Used());
        }
    }

    std::size_t Serialize(const RabitMessage &message, std::span<std::uint8_t> buffer) const override
    {
        const Message &concrete = Concrete(message);
        if (buffer.size() < EncapsulationSize)
        {
            return 0;
        }
        try
        {
            CdrWriter writer(buffer.subspan(EncapsulationSize));
            if (!Codec<Message>::Write(writer, concrete))
            {
                return 0;
            }
            const std::size_t size = SampleSize(writer.Used());
            if (size > buffer.size())
            {
                return 0;
            }
            WriteEncapsulation(buffer, writer.PadToWord());
            return size;
        }
        catch (const eprosima::fastcdr::exception::Exception &)
        {
            return 0;
        }
    }

    bool Deserialize(std::span<const std::uint8_t> bytes, RabitMessage &message) const override
    {
        auto &concrete = const_cast<Message &>(Concrete(message));
        return Decode(bytes, [&](CdrReader &reader) { return Codec<Message>::Read(reader, concrete); });
    }

    bool HasKey() const override { return Codec<Message>::HasKey; }

    bool KeyHashOf(std::span<const std::uint8_t> bytes, std::array<std::uint8_t, 16> &hash) const override
    {
        if constexpr (Codec<Message>::HasKey)
        {
            KeyHasher key(Codec<Message>::KeyFitsHash);
            if (!Decode(bytes, [&](CdrReader &reader) { return Codec<Message>::Scan(reader, &key); }))
            {
                return false;
            }
            hash = key.Finish();
            return true;
        }
        else
        {
            return false;
        }
    }

private:
    const Message &Concrete(const RabitMessage &message) const
    {
        if (typeid(message) != typeid(Message))
        {
            throw std::invalid_argument("MessageType " + _name + ": the message is of another type");
        }
        return static_cast<const Message &>(message);
    }

    // Runs a codec over the body of a sample. The reader checks all lengths, so Fast-CDR does not throw,
    // but allocation may.
    template <class Run>
    static bool Decode(std::span<const std::uint8_t> bytes, Run run)
    {
        std::span<const std::uint8_t> body;
        bool littleEndian = true;
        if (!OpenSample(bytes, body, littleEndian))
        {
            return false;
        }
        try
        {
            CdrReader reader(body, littleEndian);
            return run(reader) && reader.Left() <= MaxPadding;
        }
        catch (const eprosima::fastcdr::exception::Exception &)
        {
            return false;
        }
        catch (const std::bad_alloc &)
        {
            return false;
        }
        catch (const std::length_error &)
        {
            return false;
        }
    }

    std::string _name;
    std::string _idlText;
    std::string _rosTypeHash;
};

// RabitMessage::Serialize and DeSerialize of a generated class: the sample's bytes, stype must be 0.
inline int SerializeTo(const MessageType &type, const RabitMessage &message, std::uint8_t *buffer, int size,
                       int stype)
{
    if (buffer == nullptr || size <= 0 || stype != 0)
    {
        return 0;
    }
    // maxBufSize is an int, so the result always fits into one.
    return static_cast<int>(type.Serialize(message, std::span(buffer, static_cast<std::size_t>(size))));
}

inline int DeserializeFrom(const MessageType &type, RabitMessage &message, const std::uint8_t *buffer,
                           int size, int stype)
{
    if (buffer == nullptr || size <= 0 || stype != 0)
    {
        return 0;
    }
    return type.Deserialize(std::span(buffer, static_cast<std::size_t>(size)), message) ? size : 0;
}

}  // namespace Rabit::Idl
