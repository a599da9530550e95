#include "VendorDomain.h"

#include <mutex>
#include <set>
#include <string>

#include "DomainConfig.h"
#include "VendorLog.h"
#include "VendorTraffic.h"
#include "common/RtpsTraffic.h"

namespace Rabit::Cyclone
{

namespace
{

// The numbers of this process's domains.
class Numbers
{
public:
    // `wanted` if no session has it, so that a vendor's file that names the domain applies; else one that no
    // domain of the network has.
    static dds_domainid_t Take(dds_domainid_t wanted)
    {
        constexpr dds_domainid_t FirstOther = 1000;
        const std::lock_guard lock(Mutex());
        dds_domainid_t number = wanted;
        for (dds_domainid_t other = FirstOther; !Taken().insert(number).second; ++other)
        {
            number = other;
        }
        return number;
    }
    static void Give(dds_domainid_t number)
    {
        const std::lock_guard lock(Mutex());
        Taken().erase(number);
    }

private:
    static std::mutex &Mutex()
    {
        static std::mutex mutex;
        return mutex;
    }
    static std::set<dds_domainid_t> &Taken()
    {
        static std::set<dds_domainid_t> taken;
        return taken;
    }
};

void CountSent(void *log, const unsigned char *head, std::size_t headSize, std::size_t size)
{
    auto *const counters = static_cast<SessionLog *>(log);
    IsOfSamples({head, headSize}) ? counters->SentSamples(1, size) : counters->SentDiscovery(1, size);
}

}  // namespace

VendorDomain::VendorDomain(const TransportSettings &settings, const std::shared_ptr<SessionLog> &log)
    : _log(log)
{
    const std::string config = MakeDomainConfig(settings);
    _id = Numbers::Take(static_cast<dds_domainid_t>(settings.Domain));
    VendorLog::Follow(_id, log);
    dds_entity_t entity = 0;
    std::string said;
    {
        const VendorLogCapture capture;
        entity = dds_create_domain(_id, config.c_str());
        said = capture.FirstLine();
    }
    if (entity < 0)
    {
        VendorLog::Leave(_id);
        Numbers::Give(_id);
        const std::string why = said.empty() ? dds_strretcode(entity) : said;
        if (!settings.BackendConfig.empty())
        {
            throw TransportError(
                "Cyclone DDS does not accept the configuration " + settings.BackendConfig + ": " + why,
                "backend_config");
        }
        throw TransportError("Cyclone DDS cannot join domain " + std::to_string(settings.Domain) + ": " +
                             why);
    }
    if (!said.empty())
    {
        log->Line("Cyclone DDS: " + said);
    }
    _entity = Entity(entity, "");
    _watch = RabitCycloneWatch(&CountSent, _log.get());
    if (_watch == nullptr)
    {
        log->Line("Cyclone DDS does not show what it sends: it is not counted");
    }
}

VendorDomain::~VendorDomain()
{
    _entity.Reset();
    RabitCycloneUnwatch(_watch);
    VendorLog::Leave(_id);
    Numbers::Give(_id);
}

}  // namespace Rabit::Cyclone
