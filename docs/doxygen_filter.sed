# Makes a header's comments doxygen's (docs/Doxyfile): the page at its top, "// ..." before a declaration, and behind a member.
# Equations and tables, set off by spaces, stay as they are.
1s|^// |/// \\file\n/// |
s|^( *)//   +|\1///     |
t
/^ *\/\/( |$)/{
  s/</\&lt;/g
  s/>/\&gt;/g
}
s|^( *)//( .*)?$|\1///\2|
/^ *\}/b
s#([;,{}]) *// ?(.*)$#\1  ///< \2#
