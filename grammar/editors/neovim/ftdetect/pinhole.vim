autocmd BufNewFile,BufRead *.scn setfiletype pinhole
