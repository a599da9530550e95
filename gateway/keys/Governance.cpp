#include "keys/Governance.h"

namespace Rabit::Keys
{
namespace
{

std::string Rule(const std::string &topics, const std::string &kind)
{
    return "<topic_rule><topic_expression>" + topics +
           "</topic_expression>\n"
           "<enable_discovery_protection>true</enable_discovery_protection>\n"
           "<enable_liveliness_protection>true</enable_liveliness_protection>\n"
           "<enable_read_access_control>true</enable_read_access_control>\n"
           "<enable_write_access_control>true</enable_write_access_control>\n"
           "<metadata_protection_kind>" +
           kind +
           "</metadata_protection_kind>\n"
           "<data_protection_kind>NONE</data_protection_kind></topic_rule>\n";
}

}  // namespace

const char *NameOf(Level level)
{
    return level == Level::Sign ? "sign" : "encrypt";
}

std::string GovernanceText(Level level)
{
    const std::string kind = level == Level::Sign ? "SIGN" : "ENCRYPT";
    // The first matching rule holds. One vendor sorts rules by their expressions: in either order these two
    // have the same effect.
    const std::string rules = Rule("*/Link", kind + "_WITH_ORIGIN_AUTHENTICATION") + Rule("?*", kind);
    return R"(<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation=")"
           R"(http://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_governance.xsd">
<domain_access_rules><domain_rule><domains><id_range><min>0</min><max>)" +
           std::to_string(LargestDomain) +
           "</max></id_range></domains>\n"
           "<allow_unauthenticated_participants>false</allow_unauthenticated_participants>\n"
           "<enable_join_access_control>true</enable_join_access_control>\n"
           "<discovery_protection_kind>" +
           kind + "</discovery_protection_kind>\n<liveliness_protection_kind>" + kind +
           "</liveliness_protection_kind>\n"
           "<rtps_protection_kind>SIGN_WITH_ORIGIN_AUTHENTICATION</"
           "rtps_protection_kind>\n<topic_access_rules>\n" +
           rules + "</topic_access_rules></domain_rule></domain_access_rules></dds>\n";
}

}  // namespace Rabit::Keys
