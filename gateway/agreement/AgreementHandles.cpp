// Claims and SharedTable, which hand all over to the AgreementHub of their configuration.
#include <rabit/gateway/Claims.h>
#include <rabit/gateway/ConfigError.h>
#include <rabit/gateway/SharedTable.h>

#include <memory>
#include <utility>
#include <variant>

#include "agreement/AgreementHub.h"

namespace Rabit
{

static_assert(Claims::Most == AgreementSettings::MostClaims);
static_assert(Claims::LongestName == AgreementSettings::LongestName);
static_assert(MostAgreementMembers == AgreementSettings::MostMembers);
static_assert(SharedTable::MostKeys == TableCopy::MostKeys);
static_assert(SharedTable::LongestKey == TableEntry::LongestKey);
static_assert(SharedTable::LongestValue == TableEntry::LongestValue);

namespace
{

std::shared_ptr<AgreementHub> HubOf(GatewayConfig &config)
{
    if (!config.Agreement)
    {
        throw ConfigError(config.File, 0,
                          "claims and shared tables need the section `agreement`; expected `agreement: "
                          "{members: [<node>, ...]}`");
    }
    if (!config.Agreed)
    {
        config.Agreed = std::make_shared<AgreementHub>();
    }
    return config.Agreed;
}

// The value of a key, if it is of that kind.
template <typename Kind>
std::optional<Kind> ValueIn(const AgreementHub &hub, std::string_view key)
{
    const std::optional<TableValue> value = hub.ValueOf(key);
    const Kind *const of = value ? std::get_if<Kind>(&*value) : nullptr;
    return of == nullptr ? std::nullopt : std::optional<Kind>(*of);
}

}  // namespace

Claims::Claims(GatewayConfig &config) : _hub(HubOf(config)) {}

bool Claims::Claim(const std::string &claim)
{
    return _hub->Want(claim, true);
}

bool Claims::Try(const std::string &claim)
{
    return _hub->Want(claim, false);
}

void Claims::Release(const std::string &claim)
{
    _hub->GiveUp(claim);
}

std::optional<std::uint64_t> Claims::FenceOf(std::string_view claim) const
{
    return _hub->FenceOf(claim);
}

std::vector<std::string> Claims::Mine() const
{
    return _hub->Mine();
}

Claims::Status Claims::StatusOf(std::string_view claim) const
{
    return _hub->StatusOf(claim);
}

RabitConnection Claims::ConnectChanged(RabitHandler handler)
{
    return _hub->ClaimsChanged().Connect(std::move(handler));
}

SharedTable::SharedTable(GatewayConfig &config) : _hub(HubOf(config)) {}

std::string_view SharedTable::Write(const std::string &key, std::string value)
{
    return _hub->Write([&](TableCopy &table) { return table.Write(key, std::move(value)); });
}

std::string_view SharedTable::Add(const std::string &key, std::size_t number)
{
    return _hub->Write([&](TableCopy &table) { return table.Add(key, number); });
}

std::string_view SharedTable::Raise(const std::string &key, std::int64_t number)
{
    return _hub->Write([&](TableCopy &table) { return table.Raise(key, number); });
}

std::optional<std::string> SharedTable::Text(std::string_view key) const
{
    std::optional<LastWritten> written = ValueIn<LastWritten>(*_hub, key);
    return written ? std::optional(std::move(written->Value)) : std::nullopt;
}

std::set<std::size_t> SharedTable::Numbers(std::string_view key) const
{
    const NumberSet bits = ValueIn<NumberSet>(*_hub, key).value_or(NumberSet());
    std::set<std::size_t> numbers;
    for (std::size_t number = 0; number < bits.size(); ++number)
    {
        if (bits.test(number))
        {
            numbers.insert(numbers.end(), number);
        }
    }
    return numbers;
}

std::optional<std::int64_t> SharedTable::Number(std::string_view key) const
{
    return ValueIn<std::int64_t>(*_hub, key);
}

std::vector<std::string> SharedTable::Keys() const
{
    return _hub->Keys();
}

RabitConnection SharedTable::ConnectChanged(RabitHandler handler)
{
    return _hub->TableChanged().Connect(std::move(handler));
}

}  // namespace Rabit
