#pragma once

#include <rabit/idl/MessageType.h>

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace Rabit
{
namespace Dynamic
{
struct Shape;
struct Shapes;
}  // namespace Dynamic
struct ParsedType;
struct EncodedSample;

// A message type that is known only at run time: made from one self-contained IDL text, as
// MessageType::IdlText gives it. The text may come from an unauthenticated peer. The type encodes and
// decodes the same bytes as code generated from that text. It is a MessageType: once it is registered, a
// gateway publishes, mirrors, sends and accepts messages of it as of any other. Its messages are of class
// DynamicMessage.
//
// JSON: a struct is an object with its members in their order. An enum is the name of its value, a bitmask
// the list of the names of its bits. Octets in an array or sequence are one base64 text (RFC 4648, padded).
// A char is a text of one character, U+0000 to U+00FF for its 256 values. A string that is not UTF-8 is
// {"base64": "..."}. Floating point is written with the fewest digits that restore the value; other values
// are "NaN", "Infinity" or "-Infinity"; the sign and the payload of a NaN are lost. A union is {"case":
// value}. If its discriminator is not the first that selects the case, "_d" precedes the case; if no case
// is selected, "_d" stands alone. Control characters (C0, DEL, C1) are always escaped, in JSON and in text.
//
// Immutable; all functions may be called from any thread.
class DynamicType final : public MessageType, public std::enable_shared_from_this<DynamicType>
{
public:
    // Returns the type of that name, such as `Uav::Pose`, in an IDL text. Returns a reason and no type in
    // three cases: the generator would refuse the text, it does not define that message, or it exceeds the
    // limits in idl/dynamic/README.md. Names that are keywords in another case (`String`) need no underscore
    // here: IdlText of the type has it. Never throws on account of the text. Texts are parsed one at a time:
    // calls wait for each other.
    static ParsedType Parse(std::string_view idlText, std::string_view typeName);
    // Adds a type to the MessageTypeRegistry until the process ends. From then on configurations may name
    // it, and gateways make, send and accept its messages. Returns the type of that name in the registry:
    // the earlier one if it has the same text, also one of generated code. Null if the registry has another
    // definition of the name.
    static const MessageType *Register(const std::shared_ptr<const DynamicType> &type);
    // For Parse.
    DynamicType(std::string name, std::string idlText, std::unique_ptr<const Dynamic::Shapes> shapes);
    ~DynamicType() override;

    // How ToJson writes integers of 64 bits (long long, int64 and unsigned): as numbers, or always as text,
    // since most readers of JSON hold numbers as doubles, which round them beyond 2^53. FromJson accepts
    // both.
    enum class Wide
    {
        Number,
        Text
    };
    // A sample as JSON in one line. Nothing if Deserialize would refuse the bytes, or if the JSON would
    // exceed 64 KiB plus 256 bytes for each byte of the sample.
    std::optional<std::string> ToJson(std::span<const std::uint8_t> sample, Wide wide = Wide::Number) const;
    // A sample in the form of the generated ToString: `Uav::Pose {latitude_deg: 47.1, ...}`. Nothing in the
    // same cases as ToJson.
    std::optional<std::string> ToText(std::span<const std::uint8_t> sample) const;
    // The sample of a JSON text or value. Members that it does not name get their defaults, also in nested
    // structs. All elements of an array must be given. If the JSON does not fit, returns a reason instead
    // of bytes: the path, the expected value, and for an unknown name the nearest one. Never throws on
    // account of the JSON.
    EncodedSample FromJson(std::string_view json) const;
    EncodedSample FromJsonValue(const nlohmann::ordered_json &json) const;
    // The sample of a new message.
    const std::vector<std::uint8_t> &DefaultSample() const;
    // Size in bytes of every sample without its encapsulation; nothing if sizes differ.
    std::optional<std::size_t> FixedSize() const;

    // The sample in normal form (little endian, zeros in gaps): equal values give equal bytes. Nothing if
    // the sample is refused.
    std::optional<std::vector<std::uint8_t>> Normalized(std::span<const std::uint8_t> sample) const;

    // As a MessageType. Serialize and Deserialize take a DynamicMessage of this type, or of another object
    // of the same name and text. A message takes as much memory as its sample, so no sample is refused
    // because of memory alone.
    const std::string &Name() const override { return _name; }
    const std::string &IdlText() const override { return _idlText; }
    const std::string &RosTypeHash() const override;
    std::unique_ptr<RabitMessage> Create() const override;
    std::shared_ptr<RabitMessage> CreateShared() const override;
    std::type_index CppType() const override;
    bool IsTypeOf(const RabitMessage &message) const override;
    std::size_t SerializedSize(const RabitMessage &message) const override;
    std::size_t Serialize(const RabitMessage &message, std::span<std::uint8_t> buffer) const override;
    bool Deserialize(std::span<const std::uint8_t> bytes, RabitMessage &message) const override;
    bool HasKey() const override;
    bool KeyHashOf(std::span<const std::uint8_t> bytes, std::array<std::uint8_t, 16> &hash) const override;

    // How the type is built, for programs that make samples or read them themselves (rabit/dynamic/Shape.h).
    const Dynamic::Shape &Root() const;

    // True if the other type has the same name and text.
    bool IsSameAs(const DynamicType &other) const;

private:
    std::string _name;
    std::string _idlText;
    std::unique_ptr<const Dynamic::Shapes> _shapes;
    mutable std::once_flag _defaultOnce;
    mutable std::vector<std::uint8_t> _default;
};

// The result of parsing: a type, or the reason why there is none (one line, printable ASCII).
struct ParsedType
{
    std::shared_ptr<const DynamicType> Type;
    std::string Reason;
};

// The result of encoding: a sample, or the reason why there is none (one line, no control characters).
struct EncodedSample
{
    std::optional<std::vector<std::uint8_t>> Sample;
    std::string Reason;
};

}  // namespace Rabit
