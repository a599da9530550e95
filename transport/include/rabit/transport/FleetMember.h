// Membership of a fleet with keys: what a node's key folder holds, and the object that all of the node's
// sessions share.
//
// Set TransportSettings::Member. Each datagram of the session is then sealed before it leaves, and what does
// not open reaches neither the backend nor the gateway. Only members of the fleet are heard and answered.
#pragma once

#include <rabit/transport/Transport.h>

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace Rabit
{

// The bytes of a node's key folder.
struct MemberKeys
{
    std::array<std::uint8_t, 32> SigningKey{};    // Ed25519 seed (RFC 8032); secret
    std::array<std::uint8_t, 32> AgreementKey{};  // X25519 private key (RFC 7748); secret
    std::vector<std::uint8_t> Certificate;        // transport/envelope/Certificate.h
    std::vector<std::uint8_t> Permissions;        // transport/envelope/Permissions.h
    std::array<std::uint8_t, 32> Authority{};     // Ed25519 public key
    // Bulletins that are stored, oldest first; at least one (transport/envelope/Bulletin.h). The newest eight
    // are used.
    std::vector<std::vector<std::uint8_t>> Bulletins;
    // Stores a newer bulletin, before it is used. Called on any thread, one call at a time; must not throw.
    // Returns false if it could not store it: the bulletin is used all the same, and Problems says so. Empty:
    // none is stored.
    std::function<bool(std::uint16_t epoch, std::span<const std::uint8_t> bulletin)> Store{};
};

// A node as a member of a fleet with keys: one object for all of its sessions, on all paths. Thread-safe.
class FleetMember
{
public:
    virtual ~FleetMember() = default;
    // The node's name in its certificate. Sessions must have the same name (TransportSettings::Node).
    virtual const std::string &Name() const = 0;
    // Returns the problems that last, or are certain: nodes without keys, revoked nodes, unknown epochs, two
    // nodes or certificates with one name, a bulletin that could not be stored, dates of certificates.
    // `Setting` is `security`, `Entry` the node or address. None is Impossible. Empty if all is well. Any
    // thread.
    virtual std::vector<SettingsProblem> Problems() const = 0;
};

struct MadeMember
{
    std::shared_ptr<FleetMember> Member;  // null: Error tells why
    std::string Error;                    // one line for people; empty if there is a member
};
// Checks the keys and makes the member: keys, certificate, permissions and bulletins must belong together.
MadeMember MakeFleetMember(MemberKeys keys);

}  // namespace Rabit
