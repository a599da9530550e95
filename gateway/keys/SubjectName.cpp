#include "keys/SubjectName.h"

#include <openssl/sha.h>

#include <algorithm>
#include <charconv>

namespace Rabit::Keys
{
namespace
{

constexpr const char *Organization = "O";
constexpr const char *Unit = "OU";
constexpr const char *CommonName = "CN";

void Add(X509_NAME &name, const char *field, const std::string &value)
{
    const auto *bytes = reinterpret_cast<const unsigned char *>(value.data());
    Must(X509_NAME_add_entry_by_txt(&name, field, V_ASN1_UTF8STRING, bytes, static_cast<int>(value.size()),
                                    -1, 0) == 1,
         "make a name");
}

std::string FieldOf(const X509_NAME &name, int index, int field)
{
    const X509_NAME_ENTRY *entry = X509_NAME_get_entry(&name, index);
    const bool isField = entry != nullptr && OBJ_obj2nid(X509_NAME_ENTRY_get_object(entry)) == field;
    return TextOf(isField ? entry : nullptr);
}

}  // namespace

std::string SubjectName::Text() const
{
    return "CN=" + Node + ",OU=" + std::to_string(Number) + ",O=" + Fleet;
}

NamePtr SubjectName::Encoded() const
{
    NamePtr name = Must(NamePtr(X509_NAME_new()), "make a name");
    Add(*name, Organization, Fleet);
    Add(*name, Unit, std::to_string(Number));
    Add(*name, CommonName, Node);
    return name;
}

SubjectName SubjectOf(const X509 &certificate)
{
    const X509_NAME &name = *X509_get_subject_name(&certificate);
    const std::string number = FieldOf(name, 1, NID_organizationalUnitName);
    SubjectName subject{.Fleet = FieldOf(name, 0, NID_organizationName),
                        .Number = 0,
                        .Node = FieldOf(name, 2, NID_commonName)};
    const auto read = std::from_chars(number.data(), number.data() + number.size(), subject.Number);
    if (X509_NAME_entry_count(&name) != 3 || subject.Fleet.empty() || subject.Node.empty() ||
        number.empty() || read.ec != std::errc() || read.ptr != number.data() + number.size() ||
        subject.Number > SubjectName::LargestNumber)
    {
        throw KeysError("the certificate's subject is not of the form `CN=<node>,OU=<number>,O=<fleet>`");
    }
    return subject;
}

std::array<std::uint8_t, 6> GuidStartOf(const X509_NAME &name)
{
    unsigned char *encoded = nullptr;
    const int size = i2d_X509_NAME(&name, &encoded);
    Must(size > 0, "encode a name");
    std::array<std::uint8_t, SHA256_DIGEST_LENGTH> hash{};
    SHA256(encoded, static_cast<std::size_t>(size), hash.data());
    OPENSSL_free(encoded);
    // A one, and then the first 47 bits of the hash.
    std::array<std::uint8_t, 6> start{};
    std::uint8_t before = 1;
    for (std::size_t i = 0; i < start.size(); ++i)
    {
        start[i] = static_cast<std::uint8_t>((before & 1) << 7 | hash[i] >> 1);
        before = hash[i];
    }
    return start;
}

bool WantsSmallGuid(std::string_view transport)
{
    return transport == "cyclonedds";
}

bool HasSmallGuid(const SubjectName &subject)
{
    return (GuidStartOf(*subject.Encoded())[0] & 0x40) == 0;
}

bool IsGuidOf(const std::string &fleet, std::string_view node, std::span<const std::uint8_t, 12> guidPrefix)
{
    SubjectName subject{.Fleet = fleet, .Number = 0, .Node = std::string(node)};
    if (node.empty() || node.size() > LongestNodeName)
    {
        return false;
    }
    for (; subject.Number <= SubjectName::LargestNumber; ++subject.Number)
    {
        const auto start = GuidStartOf(*subject.Encoded());
        if (std::equal(start.begin(), start.end(), guidPrefix.begin()))
        {
            return true;
        }
    }
    return false;
}

}  // namespace Rabit::Keys
