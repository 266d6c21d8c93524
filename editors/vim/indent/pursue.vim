" Indentation of scenarios in PuRSUE-ML: a statement begins at the margin, what goes on of it stands further in.
if exists('b:did_indent')
  finish
endif
let b:did_indent = 1

setlocal indentexpr=PursueIndent()
setlocal indentkeys=o,O,<Space>,:
let b:undo_indent = 'setlocal indentexpr< indentkeys<'

if exists('*PursueIndent')
  finish
endif

let s:statement = '^\s*\%(agent\|assume\|battery\|connect\|event\|objective\|optional\|poi\|reach_objective\|rule\|state\|stateDependency\|travel\)\>'
let s:goes_on = '^\s*\%(and\|distance\|one_way\|location\|duration\|collaborative\|together\|from\|to\|takes\|before\|or\|initially\|true_if\|false_if\|only_if\|'
      \ . 'human\|controllable\|mobile\|can_do\|reacts_to\|then\|within\|in\|every\|by\|does\|at_most\|times\|waits\|between\|leaves\|never\|never_with\|do\|after\)\>'

function! PursueIndent() abort
  let line = getline(v:lnum)
  if line =~# s:goes_on
    return shiftwidth()
  endif
  if synIDattr(synID(v:lnum, indent(v:lnum) + 1, 0), 'name') ==# 'pursueComment'
    return -1
  endif
  let before = substitute(getline(prevnonblank(v:lnum - 1)), '//.*', '', '')
  if line !~# s:statement && before =~# ',\s*$'
    return shiftwidth()
  endif
  return 0
endfunction
