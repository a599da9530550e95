// Encodes JSON as the bytes of a value, or tells why it does not fit.
#pragma once

#include <rabit/dynamic/CdrBuilder.h>
#include <rabit/dynamic/Shape.h>

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

namespace Rabit::Dynamic
{

class JsonEncoder
{
public:
    using Json = nlohmann::ordered_json;

    explicit JsonEncoder(CdrBuilder &out) : _out(out) {}
    // Appends the value. False if it does not fit: then Reason tells why, and the appended bytes are
    // invalid.
    bool Put(const Shape &shape, const Json &json);
    // `legs[2].kind: expected "IDLE" or "BUSY", not 7`; printable, however hostile the JSON.
    std::string Reason() const { return (_path.empty() ? "" : _path + ": ") + _reason; }

private:
    bool PutBool(const Json &json);
    bool PutChar(const Json &json);
    bool PutInteger(const Shape &shape, const Json &json);
    bool PutFloat(const Shape &shape, const Json &json);
    bool PutText(const Shape &shape, const Json &json);
    bool PutEnum(const Shape &shape, const Json &json);
    bool PutBits(const Shape &shape, const Json &json);
    bool PutList(const Shape &shape, const Json &json);
    bool PutOctets(const Shape &shape, const Json &json);
    bool PutStruct(const Shape &shape, const Json &json);
    bool PutUnion(const Shape &shape, const Json &json);
    bool CheckLength(const Shape &shape, std::size_t length, const char *what);
    // Reads the discriminator of that value.
    bool ReadLabel(const Shape &discriminator, const Json &json, std::int64_t &label);

    bool Refuse(std::string reason);
    bool Expected(std::string_view what, const Json &json);
    bool Unknown(std::string_view what, const std::string &word, const std::vector<std::string> &known);

    CdrBuilder &_out;
    std::string _path;
    std::string _reason;
};

}  // namespace Rabit::Dynamic
