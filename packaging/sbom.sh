#!/bin/sh
# sbom.sh FACET - the libraries that facet is linked with, or opens when they are needed, in SPDX 2.3 JSON, by what
# `FACET version --json` says of its build. Needs jq. SOURCE_DATE_EPOCH is the time of creation.
set -eu
created=$(date -u -d "@${SOURCE_DATE_EPOCH:-0}" +%Y-%m-%dT%H:%M:%SZ)
"$1" version --json | jq --arg created "$created" '
    def package($name; $version; $license; $comment): {
        SPDXID: ("SPDXRef-" + ($name | gsub("[^A-Za-z0-9.-]"; "-"))), name: $name, versionInfo: $version,
        downloadLocation: "NOASSERTION", filesAnalyzed: false, licenseConcluded: $license, licenseDeclared: $license,
        copyrightText: "NOASSERTION"} + (if $comment then {comment: $comment} else {} end);
    . as $build | {
        spdxVersion: "SPDX-2.3", dataLicense: "CC0-1.0", SPDXID: "SPDXRef-DOCUMENT", name: ("facet-" + .version),
        documentNamespace: ("urn:facet:sbom:" + .version + ":" + $created),
        creationInfo: {created: $created, creators: ["Tool: facet-" + .version]},
        packages: ([package("facet"; .version; "Apache-2.0"; null)] + [.libraries[] |
            package(.name; .built_with; .license; if .file then "opened as " + .file + " when it is needed" else "linked" end)]),
        relationships: ([{spdxElementId: "SPDXRef-DOCUMENT", relationshipType: "DESCRIBES", relatedSpdxElement: "SPDXRef-facet"}] +
            [.libraries[] | {spdxElementId: "SPDXRef-facet", relationshipType: (if .file then "OPTIONAL_DEPENDENCY_OF" else "DYNAMIC_LINK" end),
                relatedSpdxElement: ("SPDXRef-" + (.name | gsub("[^A-Za-z0-9.-]"; "-")))}
             | if .relationshipType == "OPTIONAL_DEPENDENCY_OF"
               then {spdxElementId: .relatedSpdxElement, relationshipType, relatedSpdxElement: .spdxElementId} else . end])}'
