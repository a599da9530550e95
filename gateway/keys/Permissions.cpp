#include "keys/Permissions.h"

#include <rabit/base/UtcText.h>

#include <tinyxml2.h>
#include <boost/algorithm/string/replace.hpp>

#include <fnmatch.h>

#include <algorithm>
#include <string_view>

#include "keys/KeysError.h"

namespace Rabit::Keys
{
namespace
{

using tinyxml2::XMLElement;

// Vendors read a date without a zone as UTC or as local time, so the document adds a day on either side. The
// certificate's own dates are exact.
constexpr std::time_t Day = 24 * 60 * 60;

constexpr const char *TimeFormat = "%Y-%m-%dT%H:%M:%S";

std::string Escaped(std::string text)
{
    boost::algorithm::replace_all(text, "&", "&amp;");
    boost::algorithm::replace_all(text, "<", "&lt;");
    boost::algorithm::replace_all(text, ">", "&gt;");
    return text;
}

// Topics with the same partitions share one entry, to keep the document small: every node is shown all of it.
void AddEntries(const char *kind, std::vector<TopicAccess> topics, std::string &text)
{
    while (!topics.empty())
    {
        const std::vector<std::string> partitions = topics.front().Partitions;
        text += std::string("<") + kind + "><topics>";
        for (const TopicAccess &topic : topics)
        {
            if (topic.Partitions == partitions)
            {
                text += "<topic>" + Escaped(topic.Topic) + "</topic>";
            }
        }
        text += "</topics><partitions>";
        for (const std::string &partition : partitions)
        {
            text += "<partition>" + Escaped(partition) + "</partition>";
        }
        text += std::string("</partitions></") + kind + ">\n";
        std::erase_if(topics, [&](const TopicAccess &topic) { return topic.Partitions == partitions; });
    }
}

std::string ElementText(const XMLElement *element)
{
    const char *text = element == nullptr ? nullptr : element->GetText();
    return text == nullptr ? "" : text;
}

std::vector<std::string> TextsIn(const XMLElement *list, const char *name)
{
    std::vector<std::string> texts;
    for (const XMLElement *one = list == nullptr ? nullptr : list->FirstChildElement(name); one != nullptr;
         one = one->NextSiblingElement(name))
    {
        texts.push_back(ElementText(one));
    }
    return texts;
}

std::vector<TopicAccess> EntriesIn(const XMLElement &rule, const char *kind)
{
    std::vector<TopicAccess> entries;
    for (const XMLElement *entry = rule.FirstChildElement(kind); entry != nullptr;
         entry = entry->NextSiblingElement(kind))
    {
        std::vector<std::string> partitions = TextsIn(entry->FirstChildElement("partitions"), "partition");
        if (partitions.empty())
        {
            partitions.emplace_back();
        }
        for (const std::string &topic : TextsIn(entry->FirstChildElement("topics"), "topic"))
        {
            entries.push_back({topic, partitions});
        }
    }
    return entries;
}

int NumberIn(const XMLElement *element, const std::string &file)
{
    int number = -1;
    if (element == nullptr || element->QueryIntText(&number) != tinyxml2::XML_SUCCESS || number < 0)
    {
        throw KeysError(file + ": a domain is no number");
    }
    return number;
}

Permissions::Rule RuleOf(const XMLElement &element, const std::string &file)
{
    Permissions::Rule rule;
    rule.Allows = std::string_view(element.Name()) == "allow_rule";
    const XMLElement *domains = element.FirstChildElement("domains");
    for (const XMLElement *one = domains == nullptr ? nullptr : domains->FirstChildElement(); one != nullptr;
         one = one->NextSiblingElement())
    {
        const bool isRange = std::string_view(one->Name()) == "id_range";
        const int from = NumberIn(isRange ? one->FirstChildElement("min") : one, file);
        rule.Domains.emplace_back(from, isRange ? NumberIn(one->FirstChildElement("max"), file) : from);
    }
    rule.Publish = EntriesIn(element, "publish");
    rule.Subscribe = EntriesIn(element, "subscribe");
    return rule;
}

// True if the name matches the pattern. Vendors match alike.
bool Fits(const std::string &pattern, const std::string &name)
{
    return ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
}

bool Covers(const TopicAccess &entry, const TopicAccess &access)
{
    const auto isListed = [&](const std::string &partition)
    {
        return std::any_of(entry.Partitions.begin(), entry.Partitions.end(),
                           [&](const std::string &one) { return Fits(one, partition); });
    };
    return Fits(entry.Topic, access.Topic) &&
           std::all_of(access.Partitions.begin(), access.Partitions.end(), isListed);
}

bool IsAllowed(const Permissions &permissions, int domain, const TopicAccess &access,
               std::vector<TopicAccess> Permissions::Rule::*entries)
{
    for (const Permissions::Rule &rule : permissions.Rules)
    {
        const auto &listed = rule.*entries;
        if (rule.IsIn(domain) && std::any_of(listed.begin(), listed.end(),
                                             [&](const TopicAccess &entry) { return Covers(entry, access); }))
        {
            return rule.Allows;
        }
    }
    return permissions.AllowsTheRest;
}

}  // namespace

bool Permissions::Rule::IsIn(int domain) const
{
    return std::any_of(Domains.begin(), Domains.end(),
                       [domain](const auto &range)
                       { return range.first <= domain && domain <= range.second; });
}

bool Permissions::MayPublish(int domain, const TopicAccess &access) const
{
    return IsAllowed(*this, domain, access, &Rule::Publish);
}

bool Permissions::MaySubscribe(int domain, const TopicAccess &access) const
{
    return IsAllowed(*this, domain, access, &Rule::Subscribe);
}

std::string PermissionsText(const SubjectName &subject, const Validity &validity, const Access &access)
{
    std::string text = R"(<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation=")"
                       R"(http://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_permissions.xsd">
<permissions><grant name=")";
    text += subject.Node + "\"><subject_name>" + subject.Text() + "</subject_name>\n<validity><not_before>" +
            UtcText(validity.From - Day, TimeFormat) + "</not_before><not_after>" +
            UtcText(validity.To + Day, TimeFormat) + "</not_after></validity>\n<allow_rule><domains><id>" +
            std::to_string(access.Domain) + "</id></domains>\n";
    AddEntries("publish", access.Publish, text);
    AddEntries("subscribe", access.Subscribe, text);
    text += "</allow_rule><default>DENY</default></grant></permissions></dds>\n";
    return text;
}

std::vector<Permissions> ReadPermissions(const std::string &text, const std::string &file)
{
    tinyxml2::XMLDocument document;
    if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
    {
        throw KeysError(file + " is not XML: " + document.ErrorStr());
    }
    const XMLElement *root = document.FirstChildElement("dds");
    const XMLElement *list = root == nullptr ? nullptr : root->FirstChildElement("permissions");
    std::vector<Permissions> grants;
    for (const XMLElement *one = list == nullptr ? nullptr : list->FirstChildElement("grant"); one != nullptr;
         one = one->NextSiblingElement("grant"))
    {
        Permissions grant;
        grant.Subject = ElementText(one->FirstChildElement("subject_name"));
        const XMLElement *validity = one->FirstChildElement("validity");
        if (validity != nullptr)
        {
            grant.From = ElementText(validity->FirstChildElement("not_before"));
            grant.To = ElementText(validity->FirstChildElement("not_after"));
        }
        for (const XMLElement *rule = one->FirstChildElement(); rule != nullptr;
             rule = rule->NextSiblingElement())
        {
            const std::string_view name = rule->Name();
            if (name == "allow_rule" || name == "deny_rule")
            {
                grant.Rules.push_back(RuleOf(*rule, file));
            }
        }
        grant.AllowsTheRest = ElementText(one->FirstChildElement("default")) == "ALLOW";
        grants.push_back(std::move(grant));
    }
    if (grants.empty())
    {
        throw KeysError(file + " has no permissions for anybody");
    }
    return grants;
}

}  // namespace Rabit::Keys
