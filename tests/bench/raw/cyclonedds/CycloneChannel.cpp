// A plain Cyclone DDS program: the C types that `idlc -l c` makes, a listener, dds_take with loans.
#include "../RawChannel.h"

#include <dds/dds.h>

#include <array>
#include <stdexcept>
#include <utility>

#include "bench.h"

namespace Rabit::Bench
{
namespace
{

constexpr std::uint32_t MostAtOnce = 64;

dds_entity_t Check(dds_entity_t result, const char *what)
{
    if (result < 0)
    {
        throw std::runtime_error(std::string(what) + ": " + dds_strretcode(-result));
    }
    return result;
}

// The settings of transport/cyclonedds/src/DomainConfig.cpp.
std::string DomainConfig(const BenchOptions &options)
{
    const std::string datagram = std::to_string(options.Datagram);
    const std::string fragment = std::to_string(options.Datagram - 100);
    return "<Domain><General><Interfaces><NetworkInterface address=\"" + options.Interface +
           "\" multicast=\"true\"/></Interfaces><AllowMulticast>spdp</AllowMulticast>"
           "<MaxMessageSize>" +
           datagram + "B</MaxMessageSize><FragmentSize>" + fragment +
           "B</FragmentSize></General><Discovery><ExternalDomainId>" + std::to_string(options.Domain) +
           "</ExternalDomainId><ParticipantIndex>auto</ParticipantIndex>"
           "<MaxAutoParticipantIndex>100</MaxAutoParticipantIndex><LeaseDuration>3000ms</LeaseDuration>"
           "<SPDPInterval>1000ms</SPDPInterval></Discovery><Internal>"
           "<HeartbeatInterval max=\"200ms\">20ms</HeartbeatInterval><NackDelay>1ms</NackDelay>"
           "<MultipleReceiveThreads>false</MultipleReceiveThreads>"
           "<SocketReceiveBufferSize min=\"default\" max=\"4MB\"/>"
           "<Watermarks><WhcHigh>128MB</WhcHigh></Watermarks></Internal></Domain>";
}

class CycloneChannel final : public RawChannel
{
public:
    CycloneChannel(const BenchOptions &options, const std::string &writes, const std::string &reads,
                   std::function<void()> onData)
        : _onData(std::move(onData))
    {
        const auto id = static_cast<dds_domainid_t>(options.Domain);
        _domain = Check(dds_create_domain(id, DomainConfig(options).c_str()), "domain");
        const dds_entity_t participant = Check(dds_create_participant(id, nullptr, nullptr), "participant");
        const auto topic = [participant](const std::string &name) {
            return Check(dds_create_topic(participant, &Bench_Sample_desc, name.c_str(), nullptr, nullptr),
                         "topic");
        };
        dds_qos_t *qos = MakeQos(options.How);
        dds_qset_ignorelocal(qos, DDS_IGNORELOCAL_PARTICIPANT);
        _writer = Check(dds_create_writer(participant, topic(writes), qos, nullptr), "writer");
        dds_listener_t *listener = dds_create_listener(this);
        dds_lset_data_available(
            listener, [](dds_entity_t, void *self) { static_cast<CycloneChannel *>(self)->_onData(); });
        SetReaderDepth(options, qos);
        // No sample may come before the reader's handle is known.
        _reader = Check(dds_create_reader(participant, topic(reads), qos, nullptr), "reader");
        Check(dds_set_listener(_reader, listener), "listener");
        dds_delete_listener(listener);
        dds_delete_qos(qos);
    }

    ~CycloneChannel() override { dds_delete(_domain); }

    bool Write(const RawSample &sample) override
    {
        Bench_Sample value{};
        value.number = sample.Number;
        value.sent_ns = sample.SentAt;
        value.padding._length = value.padding._maximum = static_cast<std::uint32_t>(sample.Padding.size());
        value.padding._buffer = const_cast<std::uint8_t *>(sample.Padding.data());
        const dds_return_t result = dds_write(_writer, &value);
        if (result == DDS_RETCODE_TIMEOUT)
        {
            return false;
        }
        Check(result, "write");
        return true;
    }

    void Take(const std::function<void(const RawSample &)> &handler) override
    {
        std::array<void *, MostAtOnce> samples{};
        std::array<dds_sample_info_t, MostAtOnce> infos;
        while (true)
        {
            samples[0] = nullptr;
            const dds_return_t count =
                Check(dds_take(_reader, samples.data(), infos.data(), samples.size(), MostAtOnce), "take");
            if (count == 0)
            {
                return;
            }
            for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
            {
                const auto *value = static_cast<const Bench_Sample *>(samples[i]);
                if (infos[i].valid_data)
                {
                    handler(
                        {value->number, value->sent_ns, {value->padding._buffer, value->padding._length}});
                }
            }
            Check(dds_return_loan(_reader, samples.data(), count), "return loan");
        }
    }

    bool IsMatched() const override
    {
        dds_publication_matched_status_t published{};
        dds_subscription_matched_status_t subscribed{};
        dds_get_publication_matched_status(_writer, &published);
        dds_get_subscription_matched_status(_reader, &subscribed);
        return published.current_count > 0 && subscribed.current_count > 0;
    }

    void WaitForAcknowledgements() override
    {
        Check(dds_wait_for_acks(_writer, DDS_SECS(60)), "acknowledgements");
    }

private:
    static dds_qos_t *MakeQos(Carriage how)
    {
        dds_qos_t *qos = dds_create_qos();
        if (how == Carriage::Queue)
        {
            dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(5));
            dds_qset_history(qos, DDS_HISTORY_KEEP_ALL, 0);
            return qos;
        }
        dds_qset_reliability(qos,
                             how == Carriage::State ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                             DDS_MSECS(100));
        dds_qset_durability(
            qos, how == Carriage::State ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
        dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 1);
        return qos;
    }

    // If several programs write the same topic, there is room for one sample of each.
    static void SetReaderDepth(const BenchOptions &options, dds_qos_t *qos)
    {
        if (options.Role == "member")
        {
            dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, static_cast<std::int32_t>(options.Members));
        }
    }

    const std::function<void()> _onData;
    dds_entity_t _domain = 0;
    dds_entity_t _writer = 0;
    dds_entity_t _reader = 0;
};

}  // namespace

std::unique_ptr<RawChannel> OpenRawChannel(const BenchOptions &options, const std::string &writes,
                                           const std::string &reads, std::function<void()> onData)
{
    return std::make_unique<CycloneChannel>(options, writes, reads, std::move(onData));
}

}  // namespace Rabit::Bench
