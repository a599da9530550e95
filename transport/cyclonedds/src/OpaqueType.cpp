#include "OpaqueType.h"

#include <dds/ddsi/q_protocol.h>
#include <dds/ddsi/q_radmin.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <new>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "EndpointSettings.h"
#include "common/BufferPool.h"

namespace Rabit::Cyclone
{

namespace
{

constexpr std::size_t HeaderSize = 4;

struct OpaqueType
{
    ddsi_sertype Header;
    std::string Topic;
    std::function<bool(SampleBytes, KeyHash &)> KeyOf;
    std::shared_ptr<SessionLog> Log;
};

// The pool of the process. It is never destroyed, since a sample may outlive its type and its domain.
BufferPool &Samples()
{
    static auto *const samples = new BufferPool;
    return *samples;
}

OpaqueSample *Of(const ddsi_serdata *sample)
{
    return reinterpret_cast<OpaqueSample *>(const_cast<ddsi_serdata *>(sample));
}

const OpaqueType *Of(const ddsi_sertype *type)
{
    return reinterpret_cast<const OpaqueType *>(type);
}

ddsi_serdata *Refuse(const ddsi_sertype *type, const char *why, OpaqueSample *sample = nullptr)
{
    Of(type)->Log->MalformedSample(Of(type)->Topic, why);
    if (sample != nullptr)
    {
        ddsi_serdata_unref(&sample->Header);
    }
    return nullptr;
}

// Computes the key of an arrived sample; nullptr (and freed) if it has none.
ddsi_serdata *WithKey(OpaqueSample *sample, const ddsi_keyhash_t *sent)
{
    const auto *type = Of(sample->Header.type);
    if (type->KeyOf)
    {
        KeyHash key{};
        if (sent != nullptr)
        {
            std::copy_n(sent->value, key.size(), key.begin());
        }
        else if (sample->Size < HeaderSize || !type->KeyOf({sample->Data(), sample->Size}, key))
        {
            return Refuse(sample->Header.type, "it has no readable key", sample);
        }
        sample->SetKey(key);
    }
    return &sample->Header;
}

bool EqualKey(const ddsi_serdata *a, const ddsi_serdata *b)
{
    return Of(a)->Key == Of(b)->Key;
}

std::uint32_t GetSize(const ddsi_serdata *sample)
{
    return static_cast<std::uint32_t>(Of(sample)->Size);
}

ddsi_serdata *FromNetwork(const ddsi_sertype *type, ddsi_serdata_kind kind, const nn_rdata *chain,
                          std::size_t size)
{
    if (size < HeaderSize)
    {
        return Refuse(type, "it is shorter than its header");
    }
    if (size > MaxSample)
    {
        return Refuse(type, "it is larger than 64 MiB");
    }
    OpaqueSample *sample = NewSample(type, kind, size);
    const auto *submessage = reinterpret_cast<const Data_DataFrag_common_t *>(
        NN_RMSG_PAYLOADOFF(chain->rmsg, NN_RDATA_SUBMSG_OFF(chain)));
    sample->Sequence =
        (static_cast<std::uint64_t>(submessage->writerSN.high) << 32) + submessage->writerSN.low;
    const ddsi_keyhash_t *key = ddsi_serdata_keyhash_from_fragchain(chain);
    std::size_t filled = 0;
    for (; chain != nullptr; chain = chain->nextfrag)
    {
        // Fragments may overlap, and may claim more than the sample has.
        const std::size_t end = std::min<std::size_t>(chain->maxp1, size);
        if (end > filled && chain->min <= filled)
        {
            const unsigned char *payload = NN_RMSG_PAYLOADOFF(chain->rmsg, NN_RDATA_PAYLOAD_OFF(chain));
            std::memcpy(sample->Data() + filled, payload + (filled - chain->min), end - filled);
            filled = end;
        }
    }
    if (filled != size)
    {
        return Refuse(type, "a part of it is missing", sample);
    }
    return WithKey(sample, key);
}

ddsi_serdata *FromPieces(const ddsi_sertype *type, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                         const ddsrt_iovec_t *pieces, std::size_t size)
{
    OpaqueSample *sample = NewSample(type, kind, size);
    std::size_t filled = 0;
    for (ddsrt_msg_iovlen_t i = 0; i < count && filled < size; ++i)
    {
        const std::size_t more = std::min<std::size_t>(pieces[i].iov_len, size - filled);
        std::memcpy(sample->Data() + filled, pieces[i].iov_base, more);
        filled += more;
    }
    return WithKey(sample, nullptr);
}

ddsi_serdata *FromKeyHash(const ddsi_sertype *type, const ddsi_keyhash *hash)
{
    OpaqueSample *sample = NewSample(type, SDK_KEY, 0);
    return WithKey(sample, hash);
}

ddsi_serdata *FromValue(const ddsi_sertype *, ddsi_serdata_kind, const void *)
{
    return nullptr;  // values are never converted: only bytes are written
}

void ToBytes(const ddsi_serdata *sample, std::size_t offset, std::size_t size, void *buffer)
{
    std::memcpy(buffer, Of(sample)->Data() + offset, size);
}

ddsi_serdata *ToBytesRef(const ddsi_serdata *sample, std::size_t offset, std::size_t size, ddsrt_iovec_t *ref)
{
    ref->iov_base = Of(sample)->Data() + offset;
    ref->iov_len = size;
    return ddsi_serdata_ref(sample);
}

void ToBytesUnref(ddsi_serdata *sample, const ddsrt_iovec_t *)
{
    ddsi_serdata_unref(sample);
}

bool ToValue(const ddsi_serdata *, void *, void **, void *)
{
    return false;
}

ddsi_serdata *ToUntyped(const ddsi_serdata *sample)
{
    OpaqueSample *key = NewSample(sample->type, SDK_KEY, 0);
    key->Key = Of(sample)->Key;
    key->Header.hash = sample->hash;
    key->Header.type = nullptr;  // it may outlive its type
    return &key->Header;
}

bool UntypedToValue(const ddsi_sertype *, const ddsi_serdata *, void *, void **, void *)
{
    return false;
}

void FreeSample(ddsi_serdata *sample)
{
    Samples().Release({reinterpret_cast<std::uint8_t *>(sample), Of(sample)->Capacity});
}

std::size_t Print(const ddsi_sertype *, const ddsi_serdata *, char *buffer, std::size_t size)
{
    if (size > 0)
    {
        buffer[0] = '\0';
    }
    return 0;
}

void GetKeyHash(const ddsi_serdata *sample, ddsi_keyhash *hash, bool)
{
    std::copy_n(Of(sample)->Key.begin(), Of(sample)->Key.size(), hash->value);
}

void FreeType(ddsi_sertype *type)
{
    ddsi_sertype_fini(type);
    delete reinterpret_cast<OpaqueType *>(type);
}

void ZeroValues(const ddsi_sertype *, void *, std::size_t) {}
void ReallocValues(void **, const ddsi_sertype *, void *, std::size_t, std::size_t) {}
void FreeValues(const ddsi_sertype *, void **, std::size_t, dds_free_op_t) {}
bool EqualTypes(const ddsi_sertype *a, const ddsi_sertype *b)
{
    return Of(a)->Topic == Of(b)->Topic;  // names and kinds are compared by the vendor
}
std::uint32_t HashType(const ddsi_sertype *type)
{
    return static_cast<std::uint32_t>(std::hash<std::string>()(Of(type)->Topic));
}

const ddsi_serdata_ops &SampleOps()
{
    static const ddsi_serdata_ops ops = []
    {
        ddsi_serdata_ops o{};
        o.eqkey = EqualKey;
        o.get_size = GetSize;
        o.from_ser = FromNetwork;
        o.from_ser_iov = FromPieces;
        o.from_keyhash = FromKeyHash;
        o.from_sample = FromValue;
        o.to_ser = ToBytes;
        o.to_ser_ref = ToBytesRef;
        o.to_ser_unref = ToBytesUnref;
        o.to_sample = ToValue;
        o.to_untyped = ToUntyped;
        o.untyped_to_sample = UntypedToValue;
        o.free = FreeSample;
        o.print = Print;
        o.get_keyhash = GetKeyHash;
        return o;
    }();
    return ops;
}

const ddsi_sertype_ops &TypeOps()
{
    static const ddsi_sertype_ops ops = []
    {
        ddsi_sertype_ops o{};
        o.version = ddsi_sertype_v0;
        o.free = FreeType;
        o.zero_samples = ZeroValues;
        o.realloc_samples = ReallocValues;
        o.free_samples = FreeValues;
        o.equal = EqualTypes;
        o.hash = HashType;
        return o;
    }();
    return ops;
}

}  // namespace

OpaqueSample *NewSample(const ddsi_sertype *type, ddsi_serdata_kind kind, std::size_t size)
{
    static_assert(sizeof(OpaqueSample) % 8 == 0 && std::is_trivially_destructible_v<OpaqueSample>);
    // The vendor reads up to the next multiple of 4 bytes.
    const std::size_t padding = (4 - size % 4) % 4;
    const auto buffer = Samples().Acquire(static_cast<std::uint32_t>(sizeof(OpaqueSample) + size + padding));
    auto *sample = new (buffer.Data) OpaqueSample;
    ddsi_serdata_init(&sample->Header, type, kind);
    sample->Capacity = buffer.Capacity;
    sample->Size = size;
    std::fill_n(sample->Data() + size, padding, std::uint8_t{0});
    return sample;
}

void OpaqueSample::SetKey(const KeyHash &key)
{
    Key = key;
    // The vendor's tables use only the low bits, and double without a limit while these collide. So keys that
    // differ in any bit must differ there.
    const std::string_view bytes(reinterpret_cast<const char *>(key.data()), key.size());
    Header.hash ^= static_cast<std::uint32_t>(std::hash<std::string_view>()(bytes));
}

KeptInstance::KeptInstance(const ddsi_sertype *type, const TopicDescription &topic) : _type(type)
{
    if (!topic.KeyOf)
    {
        OpaqueSample *key = NewSample(type, SDK_KEY, 0);
        _instance = RabitCycloneKeepInstance(&key->Header);
        ddsi_serdata_unref(&key->Header);
    }
}

KeptInstance::~KeptInstance()
{
    RabitCycloneLetInstanceGo(_type, _instance);
}

ddsi_sertype *NewType(const TopicDescription &topic, std::shared_ptr<SessionLog> log)
{
    auto *type = new OpaqueType{};
    type->Topic = topic.Name;
    type->KeyOf = topic.KeyOf;
    type->Log = std::move(log);
    ddsi_sertype_init(&type->Header, topic.TypeName.c_str(), &TypeOps(), &SampleOps(), !topic.KeyOf);
    type->Header.allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
    return &type->Header;
}

}  // namespace Rabit::Cyclone
