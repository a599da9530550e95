// The datagrams by which nodes bring each other what they name by its hash (a blob): lists of permissions and
// bulletins in parts, and the certificate, which travels in a claim.
//
// Each is an RTPS message of one vendor-specific submessage (OMG DDSI-RTPS 2.3, 9.4.5.1.1) whose number is
// unassigned. It is sealed for all, in the class Bulletin. Numbers are little-endian:
//
//   offset  size  of the submessage's body
//   0       1     format, 1
//   1       1     n, the number of requests, up to 16
//   2       1     1 if a part follows the requests, else 0
//   3       1     0
//   4       44 n  requests: tag of the session that is asked (4); SHA-256 of the blob (32); a bit for each
//   part
//                 that is lacking (8)
//   ...     40    if a part follows: BlobKind (1); which part it is (1); 0 (2); size of the blob (4); SHA-256
//   of
//                 the blob (32)
//   ...           the part: 1,100 bytes, or what is left for the last one
//   ...     0-3   zeros, up to a multiple of 4
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "envelope/Types.h"

namespace Rabit::Envelope
{

enum class BlobKind : std::uint8_t
{
    Permissions = 0,
    Bulletin = 1,
    Certificate = 2  // asked for alone: it travels in a claim
};
constexpr std::size_t BlobKinds = 2;  // that travel in parts

// Bytes of each part but the last. Sealed and with all headers, a datagram with a part has at most 1,267
// bytes.
constexpr std::size_t BlobPartSize = 1100;
constexpr std::size_t MostBlobParts = 64;
constexpr std::size_t LargestBlob = MostBlobParts * BlobPartSize;  // the largest bulletin has 69,735 bytes
constexpr std::size_t MostBlobRequests = 16;
// Bytes of a message with neither a request nor a part; of each request; and of a message with one part and
// no request, without the part.
constexpr std::size_t BlobFront = Rtps::RtpsHeaderSize + Rtps::SubmessageHeaderSize + 4;
constexpr std::size_t BlobRequestSize = 44;
constexpr std::size_t BlobPartFront = BlobFront + 40;

constexpr std::size_t BlobPartsOf(std::size_t size)
{
    return (size + BlobPartSize - 1) / BlobPartSize;
}
// A bit for each part of a blob of that size.
constexpr std::uint64_t AllBlobPartsOf(std::size_t size)
{
    return BlobPartsOf(size) >= MostBlobParts ? ~std::uint64_t{0}
                                              : (std::uint64_t{1} << BlobPartsOf(size)) - 1;
}

struct BlobRequest
{
    SessionTag Of = 0;  // the session that is asked
    Hash Wanted{};
    std::uint64_t Parts = 0;  // bit k: part k is lacking; all bits: the size is not known yet
    bool operator==(const BlobRequest &) const = default;
};

struct BlobPart
{
    BlobKind Kind = BlobKind::Permissions;
    std::size_t Index = 0;
    std::size_t Size = 0;  // of the blob
    Hash Of{};
    std::span<const std::uint8_t> Bytes{};  // borrowed
};

struct BlobMessage
{
    std::vector<BlobRequest> Requests{};
    std::optional<BlobPart> Part{};
};

// Accepts any bytes, which begin with an RTPS header. Empty if they are no such message.
std::optional<BlobMessage> ReadBlobMessage(std::span<const std::uint8_t> message);
// `own`: the RTPS header of this session with which the message begins. The message must be one that can be
// read.
std::vector<std::uint8_t> WriteBlobMessage(const RtpsHeader &own, const BlobMessage &message);

}  // namespace Rabit::Envelope
