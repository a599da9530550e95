#include "VendorLog.h"

#include <dds/ddsrt/log.h>

#include <cstdio>
#include <map>
#include <mutex>
#include <string_view>
#include <utility>

namespace Rabit::Cyclone
{

namespace
{

struct Followed
{
    std::shared_ptr<SessionLog> Log;
    std::string LastError;
    std::map<std::string, unsigned> Told;  // how often each function of the vendor's has said something
};

struct Table
{
    std::mutex Mutex;
    std::map<dds_domainid_t, Followed> Domains;  // guarded by Mutex
};

// Never destroyed: threads of the vendor's may outlive static objects.
Table &TheTable()
{
    static auto *table = new Table;
    return *table;
}

std::string_view LineOf(const dds_log_data_t &data)
{
    std::string_view line(data.message, data.size);
    while (!line.empty() && (line.back() == '\n' || line.back() == '\0'))
    {
        line.remove_suffix(1);
    }
    return line;
}

void Sink(void *, const dds_log_data_t *data)
{
    const std::string line(LineOf(*data));
    std::shared_ptr<SessionLog> log;
    bool tell = false;
    {
        auto &table = TheTable();
        const std::lock_guard lock(table.Mutex);
        const auto found = table.Domains.find(data->domid);
        if (found != table.Domains.end())
        {
            log = found->second.Log;
            if ((data->priority & (DDS_LC_ERROR | DDS_LC_FATAL)) != 0)
            {
                found->second.LastError = line;
            }
            // So that a fault at full data rate does not flood the log.
            const unsigned times = ++found->second.Told[data->function != nullptr ? data->function : ""];
            tell = (times & (times - 1)) == 0;
        }
    }
    if (log == nullptr)
    {
        std::fprintf(stderr, "%s\n", line.c_str());
    }
    else if (line.find("malformed packet") != std::string::npos)
    {
        log->MalformedDatagram();
    }
    else if (tell)
    {
        log->Line("Cyclone DDS: " + line);
    }
}

}  // namespace

void VendorLog::Follow(dds_domainid_t domain, std::shared_ptr<SessionLog> log)
{
    static std::once_flag once;
    std::call_once(once, [] { dds_set_log_sink(&Sink, nullptr); });
    auto &table = TheTable();
    const std::lock_guard lock(table.Mutex);
    table.Domains[domain] = {std::move(log), "", {}};
}

std::string VendorLog::Leave(dds_domainid_t domain)
{
    auto &table = TheTable();
    const std::lock_guard lock(table.Mutex);
    const auto found = table.Domains.find(domain);
    if (found == table.Domains.end())
    {
        return "";
    }
    std::string error = std::move(found->second.LastError);
    table.Domains.erase(found);
    return error;
}

}  // namespace Rabit::Cyclone
