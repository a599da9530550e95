#include "PageRequest.h"

#include "Limits.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <stdexcept>
#include <string_view>

namespace Ground
{
namespace
{
using Json = nlohmann::json;

// The reason to refuse a request. Used only in this file.
class Refused : public std::runtime_error
{
public:
    using std::runtime_error::runtime_error;
};

// The fields of a request. Each must be taken once, and none may be left.
class Fields
{
public:
    explicit Fields(const Json &object) : _object(object) {}

    const Json &Take(const char *name)
    {
        const auto field = _object.find(name);
        if (field == _object.end())
            throw Refused(std::string("'") + name + "' is missing");
        ++_taken;
        return *field;
    }
    std::string Text(const char *name)
    {
        const Json &field = Take(name);
        if (!field.is_string())
            throw Refused(std::string("'") + name + "' must be a text");
        return field.get<std::string>();
    }
    double Number(const char *name, const Common::Range &range)
    {
        const Json &field = Take(name);
        if (!field.is_number())
            throw Refused(std::string("'") + name + "' must be a number");
        const double value = field.get<double>();
        const std::string problem = Common::WhyNot(std::string("'") + name + "'", value, range);
        if (!problem.empty())
            throw Refused(problem);
        return value;
    }
    void MustBeAll() const
    {
        if (_taken != _object.size())
            throw Refused("it has a field that is not known");
    }

private:
    const Json &_object;
    std::size_t _taken = 0;
};

// A visitor for ForEachNumberOf...: fills in each of the numbers.
auto TakeEach(Fields &fields)
{
    return [&fields]<typename Number>(const char *name, Number &number, const Common::Range &range)
    { number = static_cast<Number>(fields.Number(name, range)); };
}

Order ParseOrder(Fields &fields)
{
    Order order;
    order.node = fields.Text("node");
    if (!IsNodeName(order.node))
        throw Refused("'node' is no name of a node");
    const std::string kind = fields.Text("kind");
    if (kind == "home")
    {
        order.kind = OrderKind::ORDER_HOME;
    }
    else if (kind == "search")
    {
        order.kind = OrderKind::ORDER_SEARCH;
    }
    else if (kind == "goto")
    {
        order.kind = OrderKind::ORDER_GOTO;
        Common::ForEachNumberOfGoto(order, TakeEach(fields));
    }
    else
    {
        throw Refused("'kind' must be goto, home or search");
    }
    return order;
}

Uav::SearchArea ParseArea(Fields &fields)
{
    Uav::SearchArea area;
    Common::ForEachNumberOfArea(area, TakeEach(fields));
    return area;
}

std::int64_t TakeRef(Fields &fields)
{
    const Json &ref = fields.Take("ref");
    if (!ref.is_number_integer() || ref.get<double>() < 0 || ref.get<double>() > 1e15)
        throw Refused("'ref' must be a whole number from 0");
    return ref.get<std::int64_t>();
}

void Parse(const Json &object, PageRequest &request)
{
    if (!object.is_object())
        throw Refused("it is no JSON object");
    Fields fields(object);
    const std::string type = fields.Text("type");
    decltype(request.Wish) wish;
    if (type == "clock")
    {
        wish = ClockRequest{fields.Number("page_s", {0, 1e12})};
    }
    else
    {
        request.Ref = TakeRef(fields);
        if (type == "order")
            wish = ParseOrder(fields);
        else if (type == "area")
            wish = ParseArea(fields);
        else
            throw Refused("'type' must be clock, order or area");
    }
    fields.MustBeAll();
    request.Wish = std::move(wish);
}
}  // namespace

PageRequest ParsePageRequest(const std::string &text)
{
    PageRequest request;
    const Json object = Json::parse(text, nullptr, false);
    try
    {
        Parse(object, request);
    }
    catch (const Refused &refused)
    {
        request.Refusal = refused.what();
    }
    return request;
}

std::string ClockReply(const ClockRequest &request, double serverS)
{
    return Json{{"type", "clock"}, {"page_s", request.PageS}, {"server_s", serverS}}.dump();
}

std::string AcceptedReply(std::int64_t ref)
{
    return Json{{"type", "reply"}, {"ref", ref}, {"ok", true}}.dump();
}

std::string RefusedReply(std::optional<std::int64_t> ref, const std::string &reason)
{
    Json reply{{"type", "reply"}, {"ref", nullptr}, {"ok", false}, {"reason", reason}};
    if (ref)
        reply["ref"] = *ref;
    return reply.dump(-1, ' ', false, Json::error_handler_t::replace);
}

bool IsNodeName(const std::string &name)
{
    return !name.empty() && name.size() <= 64 &&
           std::all_of(name.begin(), name.end(),
                       [](char c)
                       {
                           return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                                  (c >= '0' && c <= '9') || c == '_' || c == '.' || c == '-';
                       });
}

}  // namespace Ground
