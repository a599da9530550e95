#include "VendorLog.h"

#include <dds/ddsrt/log.h>
#include <rabit/base/Assert.h>

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
    std::map<std::string, unsigned> Told;  // by function of the vendor's: number of lines
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

thread_local VendorLogCapture *TheCapture = nullptr;

void Sink(void *, const dds_log_data_t *data)
{
    const std::string line(LineOf(*data));
    if (TheCapture != nullptr)
    {
        TheCapture->Add(line);
        return;
    }
    std::shared_ptr<SessionLog> log;
    bool tell = false;
    {
        auto &table = TheTable();
        const std::lock_guard lock(table.Mutex);
        auto found = table.Domains.find(data->domid);
        if (found == table.Domains.end())
        {
            // Some lines, of sockets for instance, name no domain: the first one gets them.
            found = table.Domains.begin();
        }
        if (found != table.Domains.end())
        {
            log = found->second.Log;
            // Logs only the 1st, 2nd, 4th, 8th ... line, so that a fault at full data rate does not flood the
            // log.
            const unsigned times = ++found->second.Told[data->function != nullptr ? data->function : ""];
            tell = (times & (times - 1)) == 0;
        }
    }
    if (log == nullptr)
    {
        std::fprintf(stderr, "%s\n", SessionLog::Printable(line).c_str());
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

void TakeSink()
{
    static std::once_flag once;
    std::call_once(once, [] { dds_set_log_sink(&Sink, nullptr); });
}

}  // namespace

void VendorLog::Follow(dds_domainid_t domain, std::shared_ptr<SessionLog> log)
{
    TakeSink();
    auto &table = TheTable();
    const std::lock_guard lock(table.Mutex);
    table.Domains[domain] = {std::move(log), {}};
}

void VendorLog::Leave(dds_domainid_t domain)
{
    auto &table = TheTable();
    const std::lock_guard lock(table.Mutex);
    table.Domains.erase(domain);
}

VendorLogCapture::VendorLogCapture()
{
    TakeSink();
    RABIT_ASSERT(TheCapture == nullptr);
    TheCapture = this;
}

VendorLogCapture::~VendorLogCapture()
{
    TheCapture = nullptr;
}

void VendorLogCapture::Add(const std::string &line)
{
    if (_firstLine.empty() && line.find("'Deaf': deprecated") == std::string::npos)
    {
        _firstLine = line;
    }
}

}  // namespace Rabit::Cyclone
