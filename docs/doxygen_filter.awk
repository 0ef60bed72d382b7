# Doxygen's input filter: makes Doxygen comments of the headers' plain // comments; no line is added or moved.
#   block before #pragma once   -> \file block
#   // above a declaration      -> ///
#   declaration;  // text       -> ///<  (further lines in the same column too)
#   // above a list of those    a heading: no declaration's own
#   the only class without a comment of its own gets the file's text
# Comments in function bodies and initialisers, and those that no declaration follows, stay as they are.

# Markup in plain text is escaped; `code` is left to Doxygen's Markdown.
function escaped(text,    parts, count, i, result) {
  count = split(text, parts, "`")
  for (i = 1; i <= count; ++i) {
    if (i % 2 == 1 || i == count) gsub(/[\\@<>#&%]/, "\\\\&", parts[i])
    result = result (i > 1 ? "`" : "") parts[i]
  }
  sub(/^[.]/, "\\\\.", result)
  gsub(/et al[.] /, "et al.\\\\ ", result)  # not the end of the brief description
  return result
}

# Strings and characters lose what is between their quotes, so that no // or brace is found in them.
function without_strings(text) {
  gsub(/\\./, "__", text)
  while (match(text, /"[^"]+"/)) text = substr(text, 1, RSTART - 1) blank(RLENGTH) substr(text, RSTART + RLENGTH)
  while (match(text, /'[^'][^']?'/)) text = substr(text, 1, RSTART - 1) blank(RLENGTH) substr(text, RSTART + RLENGTH)
  return text
}
function blank(width) { return sprintf("%" width "s", "") }

# Follows the braces of the code: body > 0 inside what is not a namespace, class or enum.
function follow(code,    i, c) {
  for (i = 1; i <= length(code); ++i) {
    c = substr(code, i, 1)
    if (c == "{") {
      gsub(/template *<[^{]*> *(requires[^{]*)?/, "", statement)
      gsub(/(public|private|protected):/, "", statement)
      kind[++depth] = (body == 0 && statement ~ /^ *(inline +)?(namespace|class|struct|enum|union)([ {]|$)/) ? 0 : 1
      body += kind[depth]
      statement = ""
    } else if (c == "}") {
      if (depth > 0) body -= kind[depth--]
      if (body == 0) statement = ""
    } else if (c == ";") {
      statement = ""
    } else {
      statement = statement c
    }
  }
  statement = statement " "
}

function comment_of(text) {
  sub(/^ *\/\/ ?/, "", text)
  return text
}

{ line[NR] = $0 }

END {
  for (n = 1; n <= NR && line[n] !~ /^#pragma once/; ++n) head_ends = n
  n = 1
  if (head_ends < NR && line[1] ~ /^\/\//) {
    print "/// \\file"
    for (; n <= head_ends; ++n) {
      text = line[n] ~ /^\/\// ? escaped(comment_of(line[n])) : ""
      print "/// " text
      about_file = about_file (text == "" ? "<p>" : text " ")
    }
    ++n
    for (i = n; i <= NR; ++i) {
      if (line[i] ~ /^class [A-Z][A-Za-z0-9]*( final)?( : [^{]*)? {/ && line[i - 1] !~ /^(\/\/|template)/) {
        main_class = main_class == 0 ? i : -1
      }
    }
  }
  for (; n <= NR; ++n) {
    text = line[n]
    if (raw) {
      if (text ~ raw_end) raw = 0
      print text
    } else if (text ~ /^ *\/\//) {
      column = index(text, "//")
      if (column == trailing_column) {
        mark = "///< "
      } else if (n >= after) {
        for (after = n; line[after] ~ /^ *\/\//; ++after) {}
        mark = body == 0 && line[after] !~ /^ *($|#[^d]|}|public:|private:|protected:|namespace)/ ? "/// " : ""
        if (line[after] ~ /; +\/\/ / && line[after + 1] ~ /; +\/\/ /) mark = ""
      }
      print mark == "" ? text : substr(text, 1, column - 1) mark escaped(comment_of(text))
    } else if (text ~ /^ *#/) {
      trailing_column = 0
      print text
    } else {
      trailing_column = 0
      bare = without_strings(text)
      column = match(bare, / \/\/ /)
      code = column ? substr(bare, 1, column) : bare
      follow(code)
      if (match(code, /R"[a-z]*\(/)) {
        raw_end = "\\)" substr(code, RSTART + 2, RLENGTH - 3) "\""
        raw = text !~ raw_end
      }
      if (column && body == 0 && code !~ /[{:>] *$|^ *};? *$/) {
        trailing_column = column + 1
        print substr(text, 1, column) "///< " escaped(comment_of(substr(text, column)))
      } else {
        print (n == main_class ? "/** " about_file "*/ " : "") text
      }
    }
  }
}
