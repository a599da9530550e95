// Read access to the syntax tree of Cyclone DDS's IDL parser, for C++.
//
// The parser's own headers (idl/tree.h and others of version 0.10.2) declare enumerations in a way that C++
// does not allow. So the tree is read in IdlTree.c, in C. This file offers it as functions over opaque nodes.
// Nothing here judges the tree: what is supported is decided in ModelReader.cpp.
#pragma once

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C"
{
#endif

    // A node of the tree; it belongs to the parser. Null ends a list.
    typedef const void *TreeNode;

    enum TreeKind
    {
        TreeUnknown,
        // definitions
        TreeModule,
        TreeConst,
        TreeTypedef,
        TreeStruct,
        TreeUnion,
        TreeEnum,
        TreeBitmask,
        TreeForward,
        TreeAnnotation,
        // types; structs, unions, enums and bitmasks too
        TreeAlias,  // a typedef's declarator
        TreeString,
        TreeSequence,
        TreeBool,
        TreeChar,
        TreeOctet,
        TreeInt8,
        TreeUint8,
        TreeInt16,
        TreeUint16,
        TreeInt32,
        TreeUint32,
        TreeInt64,
        TreeUint64,
        TreeFloat,
        TreeDouble,
        TreeLongDouble,
        TreeWideChar,
        TreeWideString,
        TreeFixed,
        TreeAny
    };

    enum TreeExtensibility
    {
        TreeFinal,
        TreeAppendable,
        TreeMutable
    };

    enum TreeKind TreeKindOf(TreeNode node);
    TreeNode TreeNext(TreeNode node);
    // The node's own name, without scope; null if it has none.
    const char *TreeName(TreeNode node);
    // The construct in the words of the parser, for messages.
    const char *TreeConstruct(TreeNode node);
    const char *TreeFileOf(TreeNode node);
    uint32_t TreeLineOf(TreeNode node);
    // Whether the node is in the file that idlc was called with, not in an included one. state: const
    // idl_pstate_t *.
    bool TreeInMainFile(const void *state, TreeNode node);

    // First definition of the whole tree, and of a module.
    TreeNode TreeRoot(const void *state);
    TreeNode TreeModuleContents(TreeNode module);

    // Annotations applied to a node, first to last by TreeNext.
    TreeNode TreeAnnotations(TreeNode node);
    const char *TreeAnnotationName(TreeNode annotation);

    // Structs.
    TreeNode TreeBase(TreeNode structure);
    TreeNode TreeMembers(TreeNode structure);
    bool TreeIsNested(TreeNode structure);
    bool TreeHasKeylist(TreeNode structure);
    // Structs and unions.
    enum TreeExtensibility TreeExtensibilityOf(TreeNode node);
    // False if an annotation rules out XCDR1.
    bool TreeAllowsXcdr1(TreeNode node);

    // Members.
    TreeNode TreeDeclarators(TreeNode memberOrTypedef);
    TreeNode TreeTypeSpec(TreeNode node);
    bool TreeIsKey(TreeNode member);
    // The text of @unit, or null.
    const char *TreeUnit(TreeNode member);
    // The member id, given by @id or one of the automatic rules.
    uint32_t TreeMemberId(TreeNode declarator);
    // The literal of @default, or null.
    TreeNode TreeDefault(TreeNode member);
    // First dimension of an array declarator, or null; a literal.
    TreeNode TreeDimensions(TreeNode declarator);
    uint32_t TreeDimension(TreeNode literal);

    // Bound of a string or sequence, 0 if it has none.
    uint32_t TreeBound(TreeNode type);

    // Unions.
    TreeNode TreeSwitch(TreeNode unionNode);
    TreeNode TreeSwitchType(TreeNode switchSpec);
    bool TreeSwitchIsKey(TreeNode switchSpec);
    TreeNode TreeCases(TreeNode unionNode);
    TreeNode TreeCaseDeclarator(TreeNode caseNode);
    TreeNode TreeLabels(TreeNode caseNode);
    bool TreeIsDefaultLabel(TreeNode label);
    int64_t TreeLabelValue(TreeNode label);
    // Whether the union has a default label, and else whether there are values without a case; the value that
    // stands for it.
    bool TreeHasDefaultValue(TreeNode unionNode);
    int64_t TreeDefaultValue(TreeNode unionNode);
    uint64_t TreeUnusedLabels(TreeNode unionNode);

    // Enums and bitmasks.
    TreeNode TreeEnumerators(TreeNode enumeration);
    uint32_t TreeEnumeratorValue(TreeNode enumerator);
    TreeNode TreeDefaultEnumerator(TreeNode enumeration);
    uint16_t TreeEnumBitBound(TreeNode enumeration);
    TreeNode TreeBits(TreeNode bitmask);
    uint16_t TreeBitPosition(TreeNode bit);
    uint16_t TreeBitmaskBitBound(TreeNode bitmask);

    // Constants. The value is a literal, or an enumerator (TreeKindOf gives TreeEnum for both kinds of
    // enumerator).
    TreeNode TreeConstType(TreeNode constant);
    TreeNode TreeConstValue(TreeNode constant);
    enum TreeKind TreeLiteralKind(TreeNode literal);
    bool TreeIsEnumerator(TreeNode node);
    int64_t TreeLiteralSigned(TreeNode literal);
    uint64_t TreeLiteralUnsigned(TreeNode literal);
    double TreeLiteralDouble(TreeNode literal);
    const char *TreeLiteralString(TreeNode literal);

    // The files of this run: the main file first, then all that it includes, directly or not. sources in a
    // tree of their own: TreeFirstSource, TreeNextSource (a sibling), TreeIncludes (the first child).
    TreeNode TreeFirstSource(const void *state);
    TreeNode TreeNextSource(TreeNode source);
    TreeNode TreeIncludes(TreeNode source);
    const char *TreeSourcePath(TreeNode source);

    // The output directory given with -o, or null.
    const char *TreeOutputDirectory(const void *config);
    // The directory given with -b, or null.
    const char *TreeBaseDirectory(const void *config);

#ifdef __cplusplus
}
#endif
