autocmd BufRead,BufNewFile *.pur setfiletype pursue
