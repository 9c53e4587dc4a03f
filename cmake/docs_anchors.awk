# Doxygen's filter of Markdown pages: headings get the anchors that GitHub gives them, which doxygen does not know, and links
# within a page lead there. Names of anchors are unique over all pages by that of the file.
function slug(text) {
    text = tolower(text)
    gsub(/[^a-z0-9 _-]/, "", text)
    gsub(/ /, "-", text)
    return text
}
FNR == 1 {
    prefix = FILENAME
    if (!sub(/^.*\/docs\//, "", prefix)) sub(/^.*\//, "", prefix)
    gsub(/[^A-Za-z0-9]/, "_", prefix)
}
/^ *```/ { in_code = !in_code }
in_code { print; next }
/^##+ / {
    title = $0
    sub(/^#+ +/, "", title)
    gsub(/`|\*/, "", title)
    name = slug(title)
    if (seen[name]++) name = name "-" seen[name] - 1
    print $0 " {#" prefix "-" name "}"
    next
}
{
    rest = $0
    line = ""
    while (match(rest, /\]\(#[^)]*\)/)) {
        line = line substr(rest, 1, RSTART - 1) "](#" prefix "-" slug(substr(rest, RSTART + 3, RLENGTH - 4)) ")"
        rest = substr(rest, RSTART + RLENGTH)
    }
    print line rest
}
