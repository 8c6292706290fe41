//! Reads cells of CSV tables that contain no quotes, as text.

/// Returns the column names of a table.
pub fn columns(table: &str) -> impl Iterator<Item = &str> {
    table.lines().next().expect("a header").split(',')
}

/// Returns the cells of a column, from the first row to the last.
pub fn cells<'t>(table: &'t str, column: &str) -> Vec<&'t str> {
    let index = columns(table).position(|name| name == column).expect("a column");
    table.lines().skip(1).map(|row| row.split(',').nth(index).expect("a cell")).collect()
}

/// Returns the cell of the design with the number `design` in a column.
pub fn cell<'t>(table: &'t str, design: &str, column: &str) -> &'t str {
    let row = cells(table, "design").iter().position(|number| *number == design);
    cells(table, column)[row.expect("a design")]
}
