#pragma once

#include <string>
#include <vector>

namespace kairos::experiments {

/// A page of the report. `body` may link to any `id` of any page by `href="#id"`.
struct SitePage {
  std::string file;   ///< "errata.html"
  std::string title;  ///< as the contents name it
  std::string group;  ///< the heading that it stands under in the contents
  std::string below;  ///< links under its title: what is on it
  std::string body;
};

/// What every page has.
struct SiteFrame {
  std::string style;   ///< CSS
  std::string footer;  ///< HTML
};

/// Writes the pages of a site into `folder`. Each has the contents of all beside it, and links to
/// the page before and after; links to places of other pages lead there. Pictures are loaded when
/// they are near. Throws `RunError` where a page cannot be written, or two have the
/// same file.
void write_site(const std::string& folder, std::vector<SitePage> pages, const SiteFrame& frame);

}  // namespace kairos::experiments
